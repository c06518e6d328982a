//! The traits of quantities and kernels, and the call of a kernel by its quantity.

use super::{Declaration, Memory, Of, Subject, Uses};
use crate::linalg::Vec3;
use crate::model::{Environment, Model};
use crate::scalar::Scalar;
use alloc::vec::Vec;

/// A function of a robot and its state: its name, kernel, inputs and outputs.
pub trait Quantity: Copy + Send + Sync + 'static {
    /// The kernel that computes it.
    #[doc(hidden)]
    type Kernel: Kernel;
    /// Everything else.
    const DECLARATION: Declaration;
}

/// Code that computes one or several quantities on any number type. It is inlined into entry points compiled for an
/// instruction set.
#[doc(hidden)]
pub trait Kernel: 'static {
    /// Fills the outputs.
    fn run<S: Scalar + From<C>, C: Scalar>(call: Call<S, C>);
}

/// The most inputs of a kernel.
pub const MOST_INPUTS: usize = 4;
/// The most outputs of a kernel.
pub const MOST_OUTPUTS: usize = 4;

/// The arguments of a kernel.
#[doc(hidden)]
#[derive(Debug)]
pub struct Call<'a, S, C> {
    /// The frame, task or point.
    pub of: &'a Subject<'a>,
    /// The robot.
    pub model: &'a Model<C>,
    /// The point of {s}.
    pub point: Vec3<S>,
    /// The inputs in their order; after them zeros, if the quantity [is at rest](Declaration::is_at_rest).
    pub inputs: [&'a [S]; MOST_INPUTS],
    /// The parts of the environment that the quantity uses.
    pub environment: &'a Environment<'a, S>,
    /// Memory.
    pub memory: &'a mut Memory<S>,
    /// The kernel's outputs; those that the quantity does not keep are empty.
    pub outputs: [&'a mut [S]; MOST_OUTPUTS],
}

/// Inputs in their order; missing ones are empty.
pub(crate) type Inputs<'a, S> = [&'a [S]; MOST_INPUTS];
/// Outputs in their order; missing ones are empty.
pub(crate) type Outputs<'a, S> = [&'a mut [S]; MOST_OUTPUTS];
/// One quantity, at one state or at all states that a number of type `S` holds.
pub(crate) type Entry<S, C> = fn(&Subject, &Model<C>, &Inputs<S>, &Environment<S>, &mut Memory<S>, &mut Outputs<S>);

/// A quantity's inputs, environment and outputs, routed to its kernel: inputs that it does not have are zeros, parts of
/// the environment that it does not use absent.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn evaluate<Q: Quantity, S: Scalar + From<C>, C: Scalar>(
    of: &Subject,
    model: &Model<C>,
    inputs: &Inputs<S>,
    environment: &Environment<S>,
    memory: &mut Memory<S>,
    outputs: &mut Outputs<S>,
) {
    let declaration = const { Q::DECLARATION };
    let zeros = if declaration.is_at_rest { core::mem::take(&mut memory.zeros) } else { Vec::new() };
    let mut inputs: Inputs<S> = *inputs;
    if declaration.is_at_rest {
        inputs[declaration.inputs.len()..].fill(&zeros[..model.n()]);
    }
    let [a, b, c, d] = outputs;
    let mut outputs = [&mut **a, &mut **b, &mut **c, &mut **d];
    outputs.rotate_right(declaration.first_output());
    let part;
    let environment = match declaration.uses {
        Uses::ALL => environment,
        uses => {
            part = uses.of(environment);
            &part
        }
    };
    let point = match declaration.of {
        Of::Point => memory.point.take().unwrap_or_else(|| of.point.map(S::from_f64)),
        _ => Vec3::zero(),
    };
    Q::Kernel::run(Call { of, model, point, inputs, environment, memory, outputs });
    if declaration.is_at_rest {
        memory.zeros = zeros;
    }
}
