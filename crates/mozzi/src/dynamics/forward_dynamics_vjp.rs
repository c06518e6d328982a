//! xᵀ∂θ̈: a vector times the derivatives of forward dynamics, in O(n), without the matrices.
//!
//! In M θ̈ + h(θ, θ̇) = τ, a change of θ or θ̇ alone changes θ̈ by −M⁻¹ times the change of inverse dynamics at this
//! θ̈. M is symmetric, so that
//!
//! > xᵀ∂θ̈/∂τ = M⁻¹x = y, xᵀ∂θ̈/∂θ = −yᵀ∂τ/∂θ, xᵀ∂θ̈/∂θ̇ = −yᵀ∂τ/∂θ̇
//!
//! Forward dynamics leaves the factors that solve M y = x; the rest is [xᵀ∂τ](super::inverse_dynamics_vjp()).

use super::forward_dynamics::forward_dynamics;
use super::inverse_dynamics_vjp::from_transforms;
use crate::kinematics::joint_transforms;
use crate::linalg::ldlt;
use crate::model::{Environment, Model};
use crate::quantities::{
    ANY, CONSTANT_VECTOR, Call, DTHETA, Declaration, Kernel, Memory, Quantity, TAU, THETA, Uses, VECTOR, output, sized,
};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench};
use crate::workspace::{Articulated, Recursion, Workspace};

/// The vector-Jacobian products of [`forward_dynamics`](super::forward_dynamics()), `[xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇, xᵀ∂θ̈/∂τ]`,
/// each n long: the gradient of xᵀθ̈ for a constant x, which is n long. `memory` is for 3 n numbers.
///
/// They are xᵀ times the matrices of [`forward_dynamics_derivatives`](super::forward_dynamics_derivatives()), with the
/// same conventions: an entry of xᵀ∂θ̈/∂θ is along a velocity.
///
/// Cost O(n); O(n · depth²) if [`Model::solves_by_mass_matrix`]. No allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // the derivatives', x, and memory
pub fn forward_dynamics_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    memory: &mut [S],
    [d_theta, d_dtheta, d_tau]: [&mut [S]; 3],
) {
    let n = model.n();
    model.assert_lengths(theta.len(), [x.len(), d_theta.len(), d_dtheta.len(), d_tau.len()]);
    let (ddtheta, rest) = memory[..3 * n].split_at_mut(n);
    let (minus_y, unused) = rest.split_at_mut(n);
    solved(model, theta, dtheta, tau, x, environment, workspace, [ddtheta, d_tau]);
    for j in 0..n {
        minus_y[j] = -d_tau[j];
    }
    let outputs = [d_theta, d_dtheta, unused]; // the last is −x
    from_transforms(model, theta, dtheta, ddtheta, minus_y, environment, workspace, outputs);
}

/// θ̈, and y with M y = x; the workspace holds T_{i,i−1}(θ) afterwards.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)]
pub(super) fn solved<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    [ddtheta, y]: [&mut [S]; 2],
) {
    forward_dynamics(model, theta, dtheta, tau, environment, workspace, ddtheta);
    y.copy_from_slice(x);
    if model.solves_by_mass_matrix() {
        ldlt::solve(&model.structure.pattern, &workspace.matrix, y);
        joint_transforms(model, theta, workspace); // M's own pass leaves others
    } else {
        solve(model, workspace, y);
    }
}

pass! {
/// Overwrites x with y, M y = x, by the factors U = ĜA/d and d that forward dynamics leaves (Featherstone 2008, section
/// 7.3). Wrenches P go inward, accelerations a outward:
///
/// > u = x − AᵀP, P_p += P + U u, then y = u/d − Uᵀa, with a = a_p from the parent, a += A y
fn solve<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &mut Workspace<S>, x: &mut [S]) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, dV, F, .. }, articulated: Articulated { G_hat, U, .. }, pivots, .. } = workspace;
    let (T, a, P, U) = (&T[..slots], &mut dV[..slots], &mut F[..slots], &U[..slots]);
    P.fill(Wrench::zero());

    // tips to base: the forces left at the joints, and the wrench that each link hands on
    for (i, link) in model.inward::<S>() {
        let (j, p, Ad) = (link.j, link.parent, T[i].Ad().transpose());
        let first = model.first_sibling(i);
        x[j] -= link.A() * P[i];
        if first == 0 {
            P[p] = Ad.mul_add(P[i] + U[i] * x[j], P[p]);
        } else {
            P[p] = Ad.mul_add(P[i], P[p]);
            if first == i {
                P[p] += U[i] * x[j]; // U is in the coordinates of p
            }
        }
    }
    a[0] = Twist::zero();
    if let (true, Some(&F_0)) = (model.is_floating(), x.first_chunk()) {
        let (y, _) = ldlt::solve_6(G_hat[0].to_matrix(), (Wrench::from_array(F_0) - P[0]).to_array());
        x[..6].copy_from_slice(&y);
        a[0] = Twist::from_array(y);
    }

    // base to tips: the accelerations
    for (i, link) in model.outward::<S>() {
        let (j, a_p, first) = (link.j, a[link.parent], model.first_sibling(i));
        let a_i = T[i].Ad() * a_p;
        if first == 0 || first == i {
            x[j] = x[j] / pivots[j] - if first == 0 { a_i } else { a_p }.dot(U[i]);
        }
        a[i] = a_i + link.A() * x[j];
    }
}
}

/// See [`forward_dynamics_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamicsVjp;
impl Quantity for ForwardDynamicsVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics_vjp",
        "xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x, the gradient of xᵀθ̈; by θ along the velocities",
        &[THETA, DTHETA, TAU, CONSTANT_VECTOR],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY), output("d_tau", VECTOR, ANY)],
    )
    .uses(Uses::ALL)
    .divides();
}
impl Kernel for ForwardDynamicsVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, x], [a, b, d, _]) = (c.inputs, c.outputs);
        let Memory { workspace, matrix, .. } = c.memory;
        let memory = sized(matrix, 3 * c.model.n(), S::zero());
        forward_dynamics_vjp(c.model, theta, dtheta, tau, x, c.environment, workspace, memory, [a, b, d]);
    }
}
