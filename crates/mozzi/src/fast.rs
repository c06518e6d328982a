//! Every quantity on `f64`; those that control loops call with fused multiply-add ([`has_fused_kernel`]) if the
//! processor has it, which is detected once when the [`Workspace`] is made. No allocation after the first call.
//!
//! Results agree with the plain kernels to rounding, not bit for bit. AVX2 and AVX-512 are deliberately left out: for
//! one state they make code slower.
//!
//! ```
//! # use mozzi::{fast, quantities::{InverseDynamics, Query}};
//! # fn example(model: &mozzi::Model) {
//! let mut workspace = fast::Workspace::new(model);
//! let (theta, dtheta, ddtheta) = (vec![0.1; model.nq()], vec![0.0; model.n()], vec![0.0; model.n()]);
//! let mut tau = vec![0.0; model.n()];
//! let (query, environment) = (Query::from(InverseDynamics), model.environment());
//! fast::evaluate(&query, model, &[&theta, &dtheta, &ddtheta], &environment, &mut workspace, &mut [&mut tau]);
//! # }
//! ```

use crate::model::{Environment, Error, FrameId, Model, Pivots};
use crate::quantities::{
    self, Inputs, LIST, MassMatrix, Memory, Of, Outputs, Quantity, Query, Subject, are_clear, evaluate as run, place_of,
};
use crate::scalar::{Fused, Scalar};
use crate::spatial::Wrench;
use alloc::vec::Vec;

/// Memory for [`evaluate`], and the choice of the instruction set.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// Made by [`new`](Workspace::new) alone, if the processor has FMA: this proves that the fused entries may be
    /// called.
    fused: Option<(Memory<Fused>, Wrenches)>,
    /// For quantities without a fused entry; made by the first call of one.
    plain: Option<Memory>,
}

/// Memory for an environment's wrenches.
type Wrenches = Vec<(FrameId, Wrench<Fused>)>;

impl Workspace {
    /// Memory for this model.
    pub fn new(model: &Model) -> Self {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        if std::is_x86_feature_detected!("fma") {
            let fused = Some((Memory::new(model), Vec::with_capacity(model.frames().len())));
            return Workspace { fused, plain: None };
        }
        Self::portable(model)
    }

    /// Memory for this model, on plain `f64` whatever the processor has: bit for bit the plain kernels' results.
    pub fn portable(model: &Model) -> Self {
        Workspace { fused: None, plain: Some(Memory::new(model)) }
    }

    /// Whether this quantity is computed with fused multiply-add: by those of [`has_fused_kernel`].
    pub fn is_fused(&self, query: &Query) -> bool {
        self.fused.is_some() && has_fused_kernel(query)
    }

    /// True if every pivot of this quantity's last call is well above rounding error. If false, [`Model::compute`]
    /// checks each pivot and names what is singular. See [`Pivots`].
    pub fn are_pivots_clear(&self, query: &Query) -> bool {
        match (&self.fused, &self.plain) {
            (Some((memory, _)), _) if has_fused_kernel(query) => are_clear(query.declaration(), memory),
            (_, Some(memory)) => are_clear(query.declaration(), memory),
            _ => true,
        }
    }
}

/// The matrix that is singular at a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singular {
    /// The mass matrix, at the joint of this velocity.
    MassMatrix(usize),
    /// The task.
    Task,
}

impl Workspace {
    /// The matrix that was singular in this quantity's last call at θ, by the rule of [`Pivots`]; `None` if
    /// [`are_pivots_clear`](Self::are_pivots_clear). Overwrites M (n × n). No allocation.
    ///
    /// # Panics
    /// When θ is not nq long, or M not n².
    pub fn singular(&mut self, query: &Query, model: &Model, theta: &[f64], M: &mut [f64]) -> Option<Singular> {
        if self.are_pivots_clear(query) {
            return None;
        }
        // leaves the pivots as they are
        evaluate(&Query::from(MassMatrix), model, &[theta], &model.environment(), self, &mut [M]);
        match (&self.fused, &self.plain) {
            (Some((memory, _)), _) if has_fused_kernel(query) => singular(query, memory, model.n(), M),
            (_, Some(memory)) => singular(query, memory, model.n(), M),
            _ => None,
        }
    }
}

fn singular<S: Scalar + Into<f64>>(query: &Query, memory: &Memory<S>, n: usize, M: &[f64]) -> Option<Singular> {
    let singular = Pivots::new(memory.workspace.pivots()).first_singular(n, M).map(Singular::MassMatrix);
    let of_task = || memory.task().filter(|task| task.is_singular(n)).map(|_| Singular::Task);
    singular.or_else(|| if query.declaration().of == Of::Task { of_task() } else { None })
}

/// The outputs of a quantity at one state, matrices by rows.
///
/// # Panics
/// On a wrong number or length of slices, and if the frame is missing or belongs to another model: see
/// [`Query::check`].
#[inline]
pub fn evaluate(
    query: &Query,
    model: &Model,
    inputs: &[&[f64]],
    environment: &Environment,
    workspace: &mut Workspace,
    outputs: &mut [&mut [f64]],
) {
    match (&mut workspace.fused, ENTRIES[query.index()]) {
        (Some((memory, applied)), Some(entry)) => {
            let given = query.inputs(inputs).map(as_fused);
            let [x, y, z, w] = query.outputs(outputs);
            let mut found = [as_fused_mut(x), as_fused_mut(y), as_fused_mut(z), as_fused_mut(w)];
            // SAFETY: a Memory<Fused> is made by `Workspace::new` alone, where the processor has FMA.
            unsafe { entry(&query.subject, model, &given, (environment, applied), memory, &mut found) }
        }
        _ => {
            let memory = workspace.plain.get_or_insert_with(|| Memory::new(model));
            query.evaluate_f64(model, inputs, environment, memory, outputs);
        }
    }
}

/// [`evaluate`] with checked arguments and pivots.
///
/// # Errors
/// As [`Model::compute`].
#[inline]
pub fn compute(
    query: &Query,
    model: &Model,
    inputs: &[&[f64]],
    environment: &Environment,
    workspace: &mut Workspace,
    outputs: &mut [&mut [f64]],
) -> Result<(), Error> {
    query.check(model, inputs, environment)?;
    evaluate(query, model, inputs, environment, workspace, outputs);
    if workspace.are_pivots_clear(query) {
        return Ok(());
    }
    for (output, values) in outputs.iter_mut().zip(model.compute(*query, inputs, environment)?) {
        output.copy_from_slice(&values);
    }
    Ok(())
}

/// Whether a quantity has a kernel with fused multiply-add: those that control loops call, and that batches without
/// machine code do. The others run on plain `f64`: what is inlined into each fused entry, which is everything, takes
/// long to compile.
pub fn has_fused_kernel(query: &Query) -> bool {
    ENTRIES[query.index()].is_some()
}

/// Compiled for FMA: to be called only if the processor has it.
type Entry = unsafe fn(&Subject, &Model, &Inputs<Fused>, Around, &mut Memory<Fused>, &mut Outputs<Fused>);

/// The environment, and memory for its wrenches in fused numbers.
type Around<'a> = (&'a Environment<'a>, &'a mut Wrenches);

// a static, so that no other crate compiles these kernels again
static ENTRIES: [Option<Entry>; LIST.len()] = {
    macro_rules! entries {
        ($($Q:ident)*) => {{
            let mut all = [None; LIST.len()];
            $(all[place_of(quantities::$Q::DECLARATION.name)] = Some(fused::<quantities::$Q> as Entry);)*
            all
        }};
    }
    entries!(
        InverseDynamics ForwardDynamics MassMatrix CoriolisMatrix GravityForces BiasForces
        ForwardKinematics SpaceJacobian BodyJacobian TaskSpaceDynamics ConstrainedForwardDynamics
        InverseDynamicsDerivatives ForwardDynamicsDerivatives InverseDynamicsVjp ForwardDynamicsVjp
    )
};

/// A quantity's kernel, compiled for FMA (and AVX, which it implies).
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "fma"))]
fn fused<Q: Quantity>(
    of: &Subject,
    model: &Model,
    inputs: &Inputs<Fused>,
    (environment, applied): Around,
    memory: &mut Memory<Fused>,
    outputs: &mut Outputs<Fused>,
) {
    // here, where the parts that the quantity uses are known
    let environment = const { Q::DECLARATION.uses }.of(environment).map(Fused, applied);
    run::<Q, Fused, f64>(of, model, inputs, &environment, memory, outputs);
}

fn as_fused(x: &[f64]) -> &[Fused] {
    // SAFETY: Fused is a transparent f64.
    unsafe { core::slice::from_raw_parts(x.as_ptr().cast(), x.len()) }
}
fn as_fused_mut(x: &mut [f64]) -> &mut [Fused] {
    // SAFETY: Fused is a transparent f64, and the borrow is handed on.
    unsafe { core::slice::from_raw_parts_mut(x.as_mut_ptr().cast(), x.len()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantities as q;
    use crate::testing::{chain, floating_tree, grippers, state, tree};
    use alloc::vec;

    /// Long chains, whose links are processed in registers of four, and joints that move together.
    #[test]
    fn results_are_the_plain_kernels() {
        for model in [chain(&tree(70, 40, 0)), chain(&floating_tree(71, 33, 0)), grippers(&floating_tree(81, 14, 0))] {
            let [theta, dtheta, x] = state(&model, 5);
            let environment = model.environment();
            for query in [
                Query::from(q::MassMatrix),
                q::CoriolisMatrix.into(),
                q::InverseDynamicsDerivatives.into(),
                q::ForwardDynamics.into(),
                q::ForwardDynamicsVjp.into(),
            ] {
                let inputs = &[&theta[..], &dtheta, &x, &x][..query.declaration().inputs.len()];
                let [found, expected] = [Workspace::new(&model), Workspace::portable(&model)].map(|mut workspace| {
                    let mut outputs: Vec<Vec<f64>> =
                        query.output_lengths(&model).map(|length| vec![0.0; length]).collect();
                    let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
                    evaluate(&query, &model, inputs, &environment, &mut workspace, &mut slices);
                    outputs.concat()
                });
                let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                for (a, b) in found.iter().zip(&expected) {
                    assert!((a - b).abs() < 1e6 * f64::EPSILON * size, "{}: {a}, not {b}", query.name());
                }
            }
        }
    }
}
