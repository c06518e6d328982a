//! Inverse dynamics of an open chain: recursive Newton-Euler (Modern Robotics, section 8.3.2).

use super::joint_friction::joint_friction;
use crate::kinematics::{base_motion, joint_transforms};
use crate::model::{Environment, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::Wrench;

/// The joint forces and torques τ that produce the motion (θ, θ̇, θ̈):
///
/// > τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ̇), with f = d θ̇ + μ sgn θ̇
///
/// where M holds the rotors' inertia (armature) and F is what `environment.applied` says the robot applies to its
/// environment. N m for revolute and helical joints, N for prismatic ones. The first six entries of a free base are the
/// wrench (m, f) on it that the motion takes, in its own coordinates.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇, θ̈ or τ not n.
#[cfg_attr(not(test), inline(always))]
pub fn inverse_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    tau: &mut [S],
) {
    newton_euler(model, theta, dtheta, ddtheta, environment, workspace, tau);
    for j in 0..tau.len() {
        tau[j] += S::from(model.armature[j]) * ddtheta[j] + joint_friction(model, j, dtheta[j]);
    }
}

/// The links' part of τ, without armature and friction. Afterwards the workspace holds T, 𝒱, 𝒱̇ and 𝓕 of every link;
/// 𝓕_0 is the wrench that a bolted base applies to the chain, or that a free one, itself included, needs.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip] // one equation a line, as in the book
pub(crate) fn newton_euler<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, tau: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), tau.len()]);
    joint_transforms(model, theta, workspace);                                            // T_{i,i−1}(θ) (8.50)
    let Workspace { T, V, dV, F, .. } = workspace;

    // base: its twist, accelerating against gravity; nothing hangs from it yet
    (V[0], dV[0]) = base_motion(model, theta, dtheta, ddtheta, environment);
    F[0] = Wrench::zero();
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        F[0] = G * dV[0] - V[0].ad().transpose() * (G * V[0]);                            // (8.53)
    }

    // base to tips: twist and acceleration of each link
    for (i, link) in model.outward::<S>() {
        let (A, parent) = (link.A, link.parent);
        let (dq, ddq) = (link.rate(dtheta), link.rate(ddtheta));
        let Ad = T[i].Ad();
        V[i]  = Ad * V[parent] + A * dq;                                                  // (8.51)
        dV[i] = Ad * dV[parent] + V[i].ad() * (A * dq) + A * ddq;                         // (8.52)
    }
    // what each link's motion needs: no link waits for another
    for (i, link) in model.outward::<S>() {
        let G = link.G;
        F[i]  = G * dV[i] - V[i].ad().transpose() * (G * V[i]);                           // (8.53), its own part
    }
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;                        // by link i to the environment
    }

    // tips to base: what each joint must carry (a follower adds to its master)
    tau.fill(S::zero());
    for (i, link) in model.inward::<S>() {
        tau[link.j] += link.ratio * (link.A * F[i]);                                      // (8.54)
        let F_i = T[i].Ad().transpose() * F[i];
        F[link.parent] += F_i;                                                            // (8.53), the child's part
    }
    if model.is_floating() {
        tau[..6].copy_from_slice(&F[0].to_array());                                       // (8.54) with A = I
    }
}
