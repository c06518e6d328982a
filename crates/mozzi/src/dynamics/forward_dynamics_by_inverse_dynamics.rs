//! Forward dynamics by the book's method (Modern Robotics, section 8.5): for reading and comparison.

use super::armature::set_armature;
use super::inverse_dynamics::{inverse_dynamics, newton_euler};
use crate::linalg::{Vec3, ldlt};
use crate::model::{Environment, Model};
use crate::quantities::{
    ACCELERATION, Call, DTHETA, Declaration, Kernel, Memory, Quantity, TAU, THETA, Uses, VECTOR, output, sized,
};
use crate::scalar::Scalar;
use crate::workspace::Workspace;

/// θ̈ from τ: h + f by one call of inverse dynamics, M by n calls with θ̈ = e_i and without springs, and a dense LDLᵀ.
/// `M` is memory for n × n numbers, `e` for n, and `zeros` holds n of them; `dense` is the pattern of a full matrix.
///
/// Cost O(n³), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or θ̈ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // forward_dynamics' seven, and memory
pub(crate) fn forward_dynamics_by_inverse_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    (M, e, zeros): (&mut [S], &mut [S], &[S]),
    dense: &ldlt::Pattern,
    ddtheta: &mut [S],
) {
    let (n, nothing) = (model.n(), Environment::with_gravity(Vec3::zero()));
    set_armature(model, M);
    for i in 0..n {
        e.fill(S::zero());
        e[i] = S::one();
        let row = &mut M[i * n..][..n]; // M being symmetric
        newton_euler(model, theta, zeros, e, &nothing, workspace, row);
    }
    inverse_dynamics(model, theta, dtheta, zeros, environment, workspace, ddtheta); // h + f
    for (x, &tau) in ddtheta.iter_mut().zip(tau) {
        *x = tau - *x;
    }
    ldlt::factor(dense, M, &mut workspace.pivots);
    ldlt::solve(dense, M, ddtheta);
}

/// See [`Model::forward_dynamics_by_inverse_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamicsByInverseDynamics;
impl Quantity for ForwardDynamicsByInverseDynamics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics_by_inverse_dynamics",
        "θ̈ = M⁻¹(τ − c − g − JᵀF − f), M and h by calls of inverse dynamics",
        &[THETA, DTHETA, TAU],
        &[output("ddtheta", VECTOR, ACCELERATION)],
    )
    .uses(Uses::ALL)
    .divides();
}
impl Kernel for ForwardDynamicsByInverseDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, ..], n) = (c.inputs, c.outputs, c.model.n());
        let Memory { workspace, matrix, vector, dense, .. } = c.memory;
        let (e, zeros) = sized(vector, 2 * n, S::zero()).split_at_mut(n);
        zeros.fill(S::zero());
        let dense = dense.get_or_insert_with(|| ldlt::Pattern::new(n, n, core::iter::empty()));
        let memory = (sized(matrix, n * n, S::zero()), e, &*zeros);
        forward_dynamics_by_inverse_dynamics(
            c.model,
            theta,
            dtheta,
            tau,
            c.environment,
            workspace,
            memory,
            dense,
            ddtheta,
        );
    }
}
