//! Kernels on the numbers that derivatives need: f64, dual numbers, and dual numbers of dual numbers.
//!
//! A kernel on dual numbers is code of its own, so that only the quantities listed at the end have derivatives.

use super::registry::Entry;
use mozzi::quantities::{self, Call, Kernel, MOST_INPUTS, Memory, Quantity, Query};
use mozzi::{Dual, Model, Scalar, Vec3, fast};

/// Scratch memory for each number type.
#[derive(Default)]
pub struct Scratch {
    plain: Option<fast::Workspace>,
    dual: Option<Memory<Dual>>,
    twice: Option<Memory<Dual<Dual>>>,
}

/// A number on which quantities are evaluated.
pub trait Evaluate: Scalar + From<f64> + 'static {
    /// The robot with constants of this type.
    fn model(entry: &Entry) -> &Model<Self>;

    /// Fills the outputs, in the robot's own environment.
    ///
    /// # Errors
    /// If the quantity has no kernel on this number.
    fn evaluate(
        query: &Query,
        model: &Model<Self>,
        inputs: &[&[Self]],
        scratch: &mut Scratch,
        outputs: &mut [&mut [Self]],
    ) -> Result<(), String>;
}

impl Evaluate for f64 {
    fn model(entry: &Entry) -> &Model {
        &entry.model
    }

    fn evaluate(
        query: &Query,
        model: &Model,
        inputs: &[&[f64]],
        scratch: &mut Scratch,
        outputs: &mut [&mut [f64]],
    ) -> Result<(), String> {
        let memory = scratch.plain.get_or_insert_with(|| fast::Workspace::new(model));
        fast::evaluate(query, model, inputs, &model.environment(), memory, outputs);
        Ok(())
    }
}

#[inline(never)]
fn run<K: Kernel, S: Scalar + 'static>(
    query: &Query,
    model: &Model<S>,
    given: &[&[S]],
    memory: &mut Memory<S>,
    outputs: &mut [&mut [S]],
) {
    let declaration = query.declaration();
    let zeros = vec![S::zero(); model.n()]; // for the inputs of the kernel that the quantity does not have
    let mut inputs: [&[S]; MOST_INPUTS] = [if declaration.is_at_rest { &zeros } else { &[] }; MOST_INPUTS];
    inputs[..given.len()].copy_from_slice(given);
    let mut places: [&mut [S]; quantities::MOST_OUTPUTS] = Default::default();
    for (place, output) in places[declaration.first_output()..].iter_mut().zip(outputs) {
        *place = output;
    }
    let environment = &declaration.uses.of(&model.environment());
    K::run(Call { of: &query.subject, model, point: Vec3::zero(), inputs, environment, memory, outputs: places });
}

macro_rules! kernels {
    ($S:ty, $memory:ident, $lift:expr; $($Q:ident)*) => {
        impl Evaluate for $S {
            fn model(entry: &Entry) -> &Model<$S> {
                entry.$memory.get_or_init(|| entry.model.map($lift))
            }

            fn evaluate(
                query: &Query,
                model: &Model<$S>,
                inputs: &[&[$S]],
                scratch: &mut Scratch,
                outputs: &mut [&mut [$S]],
            ) -> Result<(), String> {
                let memory = scratch.$memory.get_or_insert_with(|| Memory::new(model));
                $(if query.index() == Query::from(quantities::$Q).index() {
                    run::<<quantities::$Q as Quantity>::Kernel, $S>(query, model, inputs, memory, outputs);
                    return Ok(());
                })*
                let known = [$(<quantities::$Q as Quantity>::DECLARATION.name),*].join(", ");
                Err(format!("{} has no derivative of this order in JAX; these have: {known}", query.name()))
            }
        }
    };
}
kernels!(
    Dual, dual, Dual::constant;
    InverseDynamics ForwardDynamics MassMatrix VelocityProduct GravityForces BiasForces ForwardKinematics SpaceJacobian
    BodyJacobian InverseDynamicsVjp ForwardDynamicsVjp Regressor
);
kernels!(
    Dual<Dual>, twice, |x| Dual::constant(Dual::constant(x));
    InverseDynamics ForwardDynamics MassMatrix VelocityProduct GravityForces BiasForces ForwardKinematics SpaceJacobian
    BodyJacobian
);
