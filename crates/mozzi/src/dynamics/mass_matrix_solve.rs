//! Forward dynamics by the mass matrix: composite rigid bodies, then LᵀDL along the tree's sparsity.

use super::bias_forces::bias_forces;
use super::joint_friction::joint_friction;
use super::mass_matrix::mass_matrix;
use super::spring_forces::add_spring_forces;
use crate::linalg::ldlt;
use crate::model::{Environment, Model};
use crate::quantities::{
    ACCELERATION, Call, DTHETA, Declaration, Kernel, Memory, Quantity, TAU, THETA, Uses, VECTOR, output, sized,
};
use crate::scalar::{Scalar, pass};
use crate::workspace::Workspace;

pass! {
/// The joint accelerations θ̈ by solving M(θ)θ̈ = τ − h(θ, θ̇) − f(θ, θ̇), with h by one call of inverse dynamics. `M`
/// is memory for n × n numbers; afterwards it holds the factors. Used where
/// [`Model::solves_by_mass_matrix`].
///
/// Cost O(n · depth²), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or θ̈ not n, or `M` not n².
pub fn forward_dynamics_by_mass_matrix<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    M: &mut [S],
    ddtheta: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    let (n, pattern) = (model.n(), &model.structure.pattern);
    bias_forces(model, theta, dtheta, environment, workspace, ddtheta);
    add_spring_forces(model, theta, ddtheta);
    for j in 0..n {
        ddtheta[j] = tau[j] - ddtheta[j] - joint_friction(model, j, dtheta[j]);
    }
    mass_matrix(model, theta, workspace, M);
    ldlt::factor(pattern, M, &mut workspace.pivots);
    ldlt::solve(pattern, M, ddtheta);
}
}

/// See [`forward_dynamics_by_mass_matrix`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamicsByMassMatrix;
impl Quantity for ForwardDynamicsByMassMatrix {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics_by_mass_matrix",
        "θ̈ = M⁻¹(τ − c − g − JᵀF − f), by composite bodies and the factors of M along the tree",
        &[THETA, DTHETA, TAU],
        &[output("ddtheta", VECTOR, ACCELERATION)],
    )
    .uses(Uses::ALL)
    .divides();
}
impl Kernel for ForwardDynamicsByMassMatrix {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, ..], n) = (c.inputs, c.outputs, c.model.n());
        let Memory { workspace, matrix, .. } = c.memory;
        let M = sized(matrix, n * n, S::zero());
        forward_dynamics_by_mass_matrix(c.model, theta, dtheta, tau, c.environment, workspace, M, ddtheta);
    }
}
