//! xᵀ∂τ and xᵀ∂θ̈ by the robot itself: inertias, friction, armature, springs, placements, axes and gravity, in O(n).
//!
//! τ = Yπ + JᵀF, so xᵀ∂τ/∂π = xᵀY. For the ten parameters of a link it is the bilinear form of its motion 𝒱, 𝒱̇ and of
//! X, how x moves it, for each unit inertia:
//!
//! > xᵀY_k = Xᵀ𝒢_k𝒱̇ − (`[ad_𝒱]`X)ᵀ𝒢_k𝒱
//!
//! **Placements and axes.** A small motion ξ of all links beyond a joint is that of a joint at rest there: its axis ξ
//! moves with the link c that carries it, Ȧ = `[ad_𝒱_c]`ξ and Ä = `[ad_𝒱̇_c]`ξ + `[ad_𝒱_c]`Ȧ, and by
//! [`vjp.rs`](super::vjp)
//!
//! > xᵀ∂τ = ξᵀ(`[ad_𝒱̇_c]`ᵀ𝓠ᶜ + `[ad_𝒱_c]`ᵀ(`[ad_𝒱_c]`ᵀ𝓠ᶜ + (𝓡ᶜ, 0)) + `[ad_X_c]`ᵀ𝓕ᶜ)
//!
//! For a placement the joint's parent carries it. To move the axis alone, the placement moves by ξ and the link, which
//! then carries, by −ξ.

use super::base_rates::BaseRates;
use super::derivatives::outward_pass;
use super::forward_dynamics_vjp::solved;
use super::regressor::joint_entries;
use super::vjp::of_base;
use crate::kinematics::{base_pose, joint_transforms};
use crate::linalg::Vec3;
use crate::model::{Environment, Model};
use crate::quantities::{
    ANY, CONSTANT_VECTOR, Call, DDTHETA, DTHETA, Declaration, Dim, Kernel, Memory, Output, Quantity, TAU, THETA, Uses,
    output, sized,
};
use crate::scalar::{Scalar, pass};
use crate::spatial::{SpatialInertia, Twist, Wrench};
use crate::workspace::{Composite, Recursion, Workspace};

/// The gradient of xᵀτ by the robot, for a constant x: `[by π, by placements, by axes, by gravity]`.
///
/// - xᵀ∂τ/∂π = xᵀY, p numbers: by the [`parameters`](Model::parameters), with Y the [`regressor`](super::regressor()).
/// - By placements, six numbers (angular, linear) for each moving link, in the order of π: by ξ when the link's joint
///   is placed at T e^{`[ξ]`}, in the frame of the link at θ = 0. A floating base comes first: by its body twist.
/// - By axes, the same of e^{`[ξ]`}, which moves the joint's axis while the links stay where they are at θ = 0; 0 for
///   balls, free joints and a floating base, which have no axis of their own.
/// - By gravity g, three numbers.
///
/// The wrench F that a frame applies has the gradient xᵀ∂τ/∂F = `J_b x`.
///
/// Along one change of the robot: [`Variation`](crate::model::Variation). Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, θ̈ or x not n, or an output not p, 6 b, 6 b and 3 for b moving links.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // inverse dynamics' own, x and the outputs
pub fn inverse_dynamics_parameter_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    outputs: [&mut [S]; 4],
) {
    joint_transforms(model, theta, workspace);
    from_transforms(model, [theta, dtheta, ddtheta, x], environment, workspace, outputs);
}

/// The gradient of xᵀθ̈ with respect to the robot's constants, for a constant x. It is the gradient of
/// [yᵀτ](inverse_dynamics_parameter_vjp) at y = −M⁻¹x. `memory` is for 2 n numbers.
///
/// Cost O(n); O(n · depth²) if [`Model::solves_by_mass_matrix`]. No allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or x not n, or an output not p, 6 b, 6 b and 3 for b moving links.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)]
pub fn forward_dynamics_parameter_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    memory: &mut [S],
    outputs: [&mut [S]; 4],
) {
    let (ddtheta, y) = memory[..2 * model.n()].split_at_mut(model.n());
    solved(model, theta, dtheta, tau, x, environment, workspace, [ddtheta, y]);
    for y in y.iter_mut() {
        *y = -*y;
    }
    from_transforms(model, [theta, dtheta, ddtheta, y], environment, workspace, outputs);
}

/// The gradient with respect to a small motion of all links beyond, in the coordinates of `[V, dV, X]`, the twists of
/// the body that carries them.
#[cfg_attr(not(debug_assertions), inline(always))]
fn of_all_beyond<S: Scalar>([V, dV, X]: [Twist<S>; 3], Q: Wrench<S>, R: Vec3<S>, F: Wrench<S>) -> Wrench<S> {
    BaseRates { X: dV, Y: Some(V), sigma: S::zero() }.dot(Q, R) + X.ad().transpose() * F
}

pass! {
/// Requires T_{i,i−1}(θ) in the workspace.
fn from_transforms<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, inputs: [&[S]; 4],
    environment: &Environment<S>, workspace: &mut Workspace<S>, products: [&mut [S]; 4],
) {
    let ([theta, dtheta, ddtheta, x], [by_pi, by_placements, by_axes, by_gravity]) = (inputs, products);
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), x.len()]);
    outward_pass(model, theta, dtheta, ddtheta, environment, Some((of_base(model, x), x)), workspace);
    let Workspace { recursion: Recursion { T, V, dV, X, F, .. }, composite: Composite { Q, B, .. }, .. } = workspace;

    by_pi.fill(S::zero());
    for (body, slot) in model.bodies().enumerate() {
        let Ad = model.link_frame(slot).map(S::from).inverse().Ad();                 // to the link's frame
        let (V, dV, X) = (Ad * V[slot], Ad * dV[slot], Ad * X[slot]);
        let of_rates = SpatialInertia::by_parameters(V.ad() * X, V);
        for (k, entry) in SpatialInertia::by_parameters(X, dV).into_iter().enumerate() {
            by_pi[10 * body + k] = entry - of_rates[k];
        }
    }
    joint_entries(model, theta, dtheta, ddtheta, |row, column, entry| {
        by_pi[column] = x[row].mul_add(entry, by_pi[column]);
    });

    by_axes.fill(S::zero());
    let (mut body, mut at_last) = (model.bodies().count(), Wrench::zero());
    for (i, link) in model.inward::<S>() {
        let (p, Ad) = (link.parent, T[i].Ad());
        let (Q_i, R_i, F_i) = (Q[i], B[i].f, F[i]);
        let T_link = model.link_frame(i).map(S::from);                       // from the link's frame
        if link.has_one_axis() || link.is_last {
            body -= 1;
            at_last = T_link.Ad().transpose() * of_all_beyond([V[i], dV[i], X[i]], Q_i, R_i, F_i);
        }
        if !link.is_next() {
            let placed = of_all_beyond([Ad * V[p], Ad * dV[p], Ad * X[p]], Q_i, R_i, F_i);
            let at_0 = T[i] * link.M.map(S::from).inverse() * T_link;                   // from the link's frame at θ = 0
            let placed = at_0.Ad().transpose() * placed;
            by_placements[6 * body..][..6].copy_from_slice(&placed.to_array());
            if link.has_one_axis() {
                by_axes[6 * body..][..6].copy_from_slice(&(placed - at_last).to_array());
            }
        }
        (F[p], Q[p]) = (Ad.transpose().mul_add(F_i, F[p]), Ad.transpose().mul_add(Q_i, Q[p]));
        B[p].f += T[i].R.inverse_mul(R_i);
    }
    let T_sb = base_pose(model, theta);
    if model.is_floating() {
        let Ad = T_sb.inverse().Ad();
        let (V_s, dV_s) = (Ad * environment.base_twist, Ad * environment.proper_base_acceleration());
        let moved = of_all_beyond([V_s, dV_s, Twist::zero()], Q[0], B[0].f, F[0]);
        by_placements[..6].copy_from_slice(&moved.to_array());
    }
    by_gravity.copy_from_slice(&(-(T_sb.R * Q[0].f)).0);
}
}

const OUTPUTS: &[Output] = &[
    output("d_parameters", &[Dim::Parameters], ANY),
    output("d_placements", &[Dim::Bodies, Dim::Is(6)], ANY),
    output("d_axes", &[Dim::Bodies, Dim::Is(6)], ANY),
    output("d_gravity", &[Dim::Is(3)], ANY),
];

/// See [`inverse_dynamics_parameter_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamicsParameterVjp;
#[doc(hidden)]
impl Quantity for InverseDynamicsParameterVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics_parameter_vjp",
        "xᵀ∂τ/∂π = xᵀY, and xᵀ∂τ by the joints' placements and axes and by gravity: the gradient of xᵀτ by the robot",
        &[THETA, DTHETA, DDTHETA, CONSTANT_VECTOR],
        OUTPUTS,
    )
    .uses(Uses::ALL)
    .is_of_masses();
}
#[doc(hidden)]
impl Kernel for InverseDynamicsParameterVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let [theta, dtheta, ddtheta, x] = c.inputs;
        let (environment, workspace) = (c.environment, &mut c.memory.workspace);
        inverse_dynamics_parameter_vjp(c.model, theta, dtheta, ddtheta, x, environment, workspace, c.outputs);
    }
}

/// See [`forward_dynamics_parameter_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamicsParameterVjp;
#[doc(hidden)]
impl Quantity for ForwardDynamicsParameterVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics_parameter_vjp",
        "xᵀ∂θ̈/∂π, and xᵀ∂θ̈ by the joints' placements and axes and by gravity: the gradient of xᵀθ̈ by the robot",
        &[THETA, DTHETA, TAU, CONSTANT_VECTOR],
        OUTPUTS,
    )
    .uses(Uses::ALL)
    .divides()
    .is_of_masses();
}
#[doc(hidden)]
impl Kernel for ForwardDynamicsParameterVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, x], n) = (c.inputs, c.model.n());
        let Memory { workspace, matrix, .. } = c.memory;
        let memory = sized(matrix, 2 * n, S::zero());
        forward_dynamics_parameter_vjp(c.model, theta, dtheta, tau, x, c.environment, workspace, memory, c.outputs);
    }
}
