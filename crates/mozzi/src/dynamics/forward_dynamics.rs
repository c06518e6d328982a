//! Forward dynamics: the articulated-body algorithm (Featherstone 2008, section 7.3).

use super::joint_friction::joint_friction;
use super::mass_matrix_solve::forward_dynamics_by_mass_matrix;
use crate::kinematics::{base_motion, joint_transforms};
use crate::linalg::ldlt;
use crate::model::{Environment, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};

/// The joint accelerations θ̈ that the joint forces and torques τ produce:
///
/// > M(θ)θ̈ = τ − c(θ, θ̇) − g(θ) − JᵀF − f(θ̇)
///
/// The inverse of [`inverse_dynamics`](super::inverse_dynamics()). By articulated bodies in O(n), a free base by a 6 × 6 LDLᵀ at the root; where joints follow
/// others, by the mass matrix. No allocation. Where M is singular the result is not finite or meaningless: the methods
/// of [`Model`] look at the pivots and answer with an error.
///
/// # Panics
/// When θ is not nq long, or θ̇, τ or θ̈ not n.
#[cfg_attr(not(test), inline(always))]
pub fn forward_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    ddtheta: &mut [S],
) {
    if model.is_coupled() {
        let mut M = core::mem::take(&mut workspace.matrix);
        forward_dynamics_by_mass_matrix(model, theta, dtheta, tau, environment, workspace, &mut M, ddtheta);
        workspace.matrix = M;
    } else {
        articulated_bodies(model, theta, dtheta, tau, environment, workspace, ddtheta);
    }
}

/// Each link's articulated inertia Ĝ and bias wrench 𝓕 are what it presents to its joint while all joints beyond it
/// are free.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
fn articulated_bodies<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], tau: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    joint_transforms(model, theta, workspace);
    let Workspace { T, V, dV, F, G_hat, U, u, pivots, vector, .. } = workspace;
    vector.fill(S::zero());
    (V[0], dV[0]) = base_motion(model, theta, dtheta, vector, environment);
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        F[0] = -(V[0].ad().transpose() * (G * V[0]));
        G_hat[0] = G.into();
    }

    // base to tips: twists, and what each link's motion needs at no acceleration
    for (i, link) in model.outward::<S>() {
        let (A, G, dq) = (link.A, link.G, link.rate(dtheta));
        V[i]  = T[i].Ad() * V[link.parent] + A * dq;
        dV[i] = V[i].ad() * (A * dq);                                        // velocity-product acceleration
        F[i]  = -(V[i].ad().transpose() * (G * V[i]));
        G_hat[i] = G.into();
    }
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;
    }

    // tips to base: free each joint and hand what is left to the parent
    for (i, link) in model.inward::<S>() {
        let (A, j) = (link.A, link.j);
        let GA = G_hat[i] * A;
        let d  = A * GA + S::from(model.armature[j]);
        let one_over_d = S::one() / d;
        u[i] = (tau[j] - joint_friction(model, j, dtheta[j]) - A * F[i]) * one_over_d;
        U[i] = GA * one_over_d;
        pivots[j] = d;
        if link.parent > 0 || model.is_floating() {
            let G_a = G_hat[i].minus_outer(GA, one_over_d);
            let F_a = F[i] + G_a * dV[i] + GA * u[i];
            let Ad  = T[i].Ad();
            let (G_i, F_i) = (G_a.congruence(Ad), Ad.transpose() * F_a);
            G_hat[link.parent] += G_i;
            F[link.parent]     += F_i;
        }
    }

    // a free base: Ĝ𝒱̇ = 𝓕_τ − 𝓕, all joints being free
    if let (Some(&F_tau), true) = (tau.first_chunk(), model.is_floating()) {
        let needed = Wrench::from_array(F_tau) - F[0] - G_hat[0] * dV[0];
        let (ddbase, base_pivots) = ldlt::solve_6(G_hat[0].to_matrix(), needed.to_array());
        pivots[..6].copy_from_slice(&base_pivots);
        ddtheta[..6].copy_from_slice(&ddbase);
        dV[0] += Twist::from_array(ddbase);
    }

    // base to tips: accelerations
    for (i, link) in model.outward::<S>() {
        let dV_i = T[i].Ad() * dV[link.parent] + dV[i];
        ddtheta[link.j] = u[i] - dV_i.dot(U[i]);
        dV[i] = dV_i + link.A * ddtheta[link.j];
    }
}
