//! ∂θ̈ of forward dynamics, by those of inverse dynamics and the factors of M (Carpentier and Mansard 2018).

use super::forward_dynamics::forward_dynamics;
use super::inverse_dynamics_derivatives::derivatives;
use crate::linalg::ldlt;
use crate::model::{Environment, Model, Workspace};
use crate::scalar::Scalar;

/// θ̈ of [`forward_dynamics`](super::forward_dynamics()), and its derivatives `[∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹]`, each n × n, row-major: row i is
/// θ̈_i's, and columns are as of [`inverse_dynamics_derivatives`](super::inverse_dynamics_derivatives()).
///
/// Inverse dynamics τ(θ, θ̇, θ̈(θ, θ̇, τ)) = τ, differentiated:
///
/// > ∂θ̈/∂θ = −M⁻¹ ∂τ/∂θ, ∂θ̈/∂θ̇ = −M⁻¹ ∂τ/∂θ̇, ∂θ̈/∂τ = M⁻¹, all at this θ̈
///
/// Where M is singular the results are not finite or meaningless: the methods of [`Model`] look at the pivots and answer with an
/// error.
///
/// Cost O(n² · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or θ̈ not n, or a derivative not n².
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
#[allow(clippy::too_many_arguments)] // forward_dynamics' seven, and the derivatives
pub fn forward_dynamics_derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], tau: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, ddtheta: &mut [S], [by_theta, by_dtheta, by_tau]: [&mut [S]; 3],
) {
    let (n, pattern) = (model.n(), &model.structure.pattern);
    forward_dynamics(model, theta, dtheta, tau, environment, workspace, ddtheta);         // leaves T_{i,i−1}(θ)
    derivatives(model, theta, dtheta, ddtheta, environment, workspace, by_theta, Some([by_dtheta, by_tau]));
    ldlt::factor(pattern, n, by_tau);
    ldlt::solve_rows(pattern, n, by_tau, by_theta);
    ldlt::solve_rows(pattern, n, by_tau, by_dtheta);
    for (j, pivot) in workspace.pivots.iter_mut().enumerate() {
        *pivot = by_tau[j * n + j];
    }
    ldlt::invert(pattern, n, by_tau, &mut workspace.vector);
}
