//! Inverse dynamics of an open chain: recursive Newton-Euler (Modern Robotics, section 8.3.2).

use super::armature::{add_rotor_forces, add_velocity_products};
use super::joint_friction::joint_friction;
use super::several_axes::carrier_twist;
use super::spring_forces::add_spring_forces;
use crate::kinematics::{base_motion, joint_sines};
use crate::model::{Environment, Model};
use crate::quantities::{Call, DDTHETA, DTHETA, Declaration, FORCE, Kernel, Quantity, THETA, Uses, VECTOR, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::Wrench;
use crate::workspace::{Recursion, Workspace};

/// The joint forces and torques τ that produce the motion (θ, θ̇, θ̈):
///
/// > τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇), with f = k(θ − θ₀) + d θ̇ + μ sgn θ̇
///
/// where M includes the rotors' inertia (armature) and F are the wrenches that the robot applies to its environment,
/// `environment.applied`. N m for revolute and helical joints, N for prismatic ones. The first six entries of a
/// floating base are the wrench (m, f) that the motion requires on the base, in its own coordinates.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇, θ̈ or τ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn inverse_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    tau: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), tau.len()]);
    for j in 0..model.n() {
        tau[j] = S::from(model.armature[j]).mul_add(ddtheta[j], joint_friction(model, j, dtheta[j]));
    }
    newton_euler(model, theta, dtheta, ddtheta, environment, workspace, tau);
    add_rotor_forces(model, ddtheta, tau);
    add_spring_forces(model, theta, tau);
}

pass! {
/// Adds the links' part of τ and all velocity products to `tau`, without friction, springs and the armature's part of
/// Mθ̈. Afterwards the workspace holds T, 𝒱, 𝒱̇ and 𝓕 of every link, 𝒱 and 𝒱̇ in the classical form below. 𝓕_0 is the
/// wrench that a fixed base applies to the chain, or that a floating base, itself included, needs.
///
/// **Classical acceleration.** The equations of a body are the same in every frame in uniform motion. One such frame
/// moves, at this moment, with the origin of link i: in it 𝒱_i = (ω, 0) and 𝒱̇_i = (ω̇, a), with the acceleration a =
/// v̇ + ω × v of the origin. Link i's motion is computed from its parent's in this form by the book's equations, then
/// converted to the frame that moves with its own origin. The wrench 𝓕_i is the same in both; the linear part of 𝒱
/// costs nothing.
pub fn newton_euler<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, tau: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), tau.len()]);
    joint_sines(model, theta, workspace);

    // base: its twist and acceleration, with gravity as an upward acceleration; no child wrench is added yet
    let (V_0, dV_0) = base_motion(model, theta, dtheta, ddtheta, environment);
    let (V_0, dV_0) = V_0.classical_acceleration(dV_0);
    (workspace.recursion.V[0], workspace.recursion.dV[0]) = (V_0.twist(), dV_0);
    workspace.recursion.F[0] = Wrench::zero();
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        workspace.recursion.F[0] = G * dV_0 - V_0.ad_transpose() * (G * V_0);                       // (8.53)
    }

    // base to tips: twist and acceleration of each link, and the wrench for its own motion
    match model.structure.of_one_axis {
        true => motions::<true, S, C>(model, theta, dtheta, ddtheta, workspace),
        false => motions::<false, S, C>(model, theta, dtheta, ddtheta, workspace),
    }
    let slots = model.links.len() + 1;
    let (T, F) = (&workspace.recursion.T[..slots], &mut workspace.recursion.F[..slots]);
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;                        // by link i to the environment
    }

    // tips to base: the force of each joint (a mimic joint adds to its source joint)
    for (i, link) in model.inward::<S>() {
        let p = link.parent;
        tau[link.j] += link.A() * F[i];                                  // (8.54)
        F[p] = T[i].Ad().transpose().mul_add(F[i], F[p]);                                 // (8.53), the child's part
    }
    if model.is_floating() {
        for (tau, F) in tau.iter_mut().zip(F[0].to_array()) { *tau += F; }                // (8.54) with A = I
    }
    add_velocity_products(model, dtheta, tau);
}
}

/// Outward from the base: 𝒱 and 𝒱̇ of each link, and the wrench for its own motion in 𝓕. `ONE_AXIS`: all joints have
/// one axis.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn motions<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], workspace: &mut Workspace<S>,
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, V, dV, F, carrier, sin_cos, .. }, .. } = workspace;
    let (T, V, dV, F, sin_cos) = (&mut T[..slots], &mut V[..slots], &mut dV[..slots], &mut F[..slots], &sin_cos[..slots]);
    for (i, link) in model.outward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (A, p) = (link.A(), link.parent);
        let (dq, ddq) = (dtheta[link.j], ddtheta[link.j]);
        let T_i  = link.transform_with(sin_cos[i], theta);                                // T_{i,i−1}(θ) (8.50)
        let V_i  = T_i.Ad() * V[p].spin() + A * dq;                                       // (8.51)
        let V_c  = carrier_twist(&link, T_i, V_i, V, &mut carrier[..], i);
        let dV_i = T_i.Ad() * dV[p] + V_c.ad() * (A * dq) + A * ddq;                      // (8.52)
        let (V_i, dV_i) = V_i.classical_acceleration(dV_i);
        (T[i], V[i], dV[i]) = (T_i, V_i.twist(), dV_i);
        F[i] = link.G() * dV_i - V_i.ad_transpose() * (link.G() * V_i);                   // (8.53), its own part
    }
}

/// See [`inverse_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamics;
impl Quantity for InverseDynamics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics",
        "τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇), the joint forces of a motion",
        &[THETA, DTHETA, DDTHETA],
        &[output("tau", VECTOR, FORCE)],
    )
    .uses(Uses::ALL);
}
impl Kernel for InverseDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [tau, ..]) = (c.inputs, c.outputs);
        inverse_dynamics(c.model, theta, dtheta, ddtheta, c.environment, &mut c.memory.workspace, tau);
    }
}
