//! Forward dynamics: the articulated-body algorithm (Featherstone 2008, section 7.3).

use super::armature::add_velocity_products;
use super::inverse_dynamics::carrier_twist;
use super::joint_friction::joint_friction;
use super::mass_matrix_solve::forward_dynamics_by_mass_matrix;
use super::spring_forces::add_spring_forces;
use crate::kinematics::{base_motion, joint_sines};
use crate::linalg::ldlt;
use crate::model::{Environment, Model, Workspace};
use crate::quantity::{ACCELERATION, Call, DTHETA, Declaration, Kernel, Quantity, TAU, THETA, Uses, VECTOR, output};
use crate::scalar::{Scalar, apart};
use crate::spatial::{Twist, Wrench};

/// The joint accelerations θ̈ that the joint forces and torques τ produce:
///
/// > M(θ)θ̈ = τ − c(θ, θ̇) − g(θ) − JᵀF − f(θ, θ̇)
///
/// The inverse of [`inverse_dynamics`](super::inverse_dynamics()). By articulated bodies in O(n), a floating base by a
/// 6 × 6 LDLᵀ at the root; by the mass matrix if [`Model::solves_by_mass_matrix`]. No allocation. If M is singular, the
/// result is infinite, NaN or meaningless: the methods of [`Model`] check the pivots and return an error.
///
/// # Panics
/// When θ is not nq long, or θ̇, τ or θ̈ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn forward_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    ddtheta: &mut [S],
) {
    if model.solves_by_mass_matrix() {
        let mut M = core::mem::take(&mut workspace.matrix);
        forward_dynamics_by_mass_matrix(model, theta, dtheta, tau, environment, workspace, &mut M, ddtheta);
        workspace.matrix = M;
    } else {
        articulated_bodies(model, theta, dtheta, tau, environment, workspace, ddtheta);
    }
}

apart! {
/// Ĝ and 𝓕 of each link are its articulated inertia and bias wrench, felt at its joint while all joints beyond it are
/// free. A joint and its mimic joints on the same link p free their links together: d and the columns ĜA of all add up,
/// in p's coordinates, at the first of them.
fn articulated_bodies<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], tau: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    joint_sines(model, theta, workspace);
    let Workspace { V, dV, F, G_hat, vector, .. } = workspace;
    vector.fill(S::zero());
    let (V_0, dV_0) = base_motion(model, theta, dtheta, vector, environment);
    let (V_0, dV_0) = V_0.classical_acceleration(dV_0);
    (V[0], dV[0]) = (V_0.twist(), dV_0);
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        F[0] = -(V_0.ad_transpose() * (G * V_0));
        G_hat[0] = G.into();
    }

    // f − τ, stored in θ̈ until that is known
    for j in 0..model.n() {
        ddtheta[j] = joint_friction(model, j, dtheta[j]) - tau[j];
    }
    add_spring_forces(model, theta, ddtheta);
    add_velocity_products(model, dtheta, ddtheta);

    // base to tips: twists, and the wrench for each link's motion if no joint accelerates
    match model.structure.of_one_axis {
        true => motions::<true, S, C>(model, theta, dtheta, workspace),
        false => motions::<false, S, C>(model, theta, dtheta, workspace),
    }
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        workspace.F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;
    }
    match model.structure.siblings.is_empty() {
        true => free_joints::<false, S, C>(model, workspace, ddtheta),
        false => free_joints::<true, S, C>(model, workspace, ddtheta),
    }
    let Workspace { dV, F, G_hat, pivots, .. } = &mut *workspace;

    // a floating base: Ĝ𝒱̇ = 𝓕_τ − 𝓕, all joints being free
    if let (Some(&F_tau), true) = (tau.first_chunk(), model.is_floating()) {
        let needed = Wrench::from_array(F_tau) - F[0] - G_hat[0] * dV[0];
        let (ddbase, base_pivots) = ldlt::solve_6(G_hat[0].to_matrix(), needed.to_array());
        pivots[..6].copy_from_slice(&base_pivots);
        ddtheta[..6].copy_from_slice(&ddbase);
        dV[0] += Twist::from_array(ddbase);
    }

    match model.structure.siblings.is_empty() {
        true => accelerations::<false, S, C>(model, workspace, ddtheta),
        false => accelerations::<true, S, C>(model, workspace, ddtheta),
    }
}
}

/// Outward from the base, with no joint accelerating: 𝒱 of each link, its own part of 𝒱̇ (without the parent's), and
/// its own 𝓕 and 𝒢.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn motions<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], workspace: &mut Workspace<S>,
) {
    let slots = model.links.len() + 1;
    let Workspace { T, V, dV, F, carrier, G_hat, sin_cos, .. } = workspace;
    let (T, V, dV, F, sin_cos) = (&mut T[..slots], &mut V[..slots], &mut dV[..slots], &mut F[..slots], &sin_cos[..slots]);
    let G_hat = &mut G_hat[..slots];
    for (i, link) in model.outward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (A, dq) = (link.A(), dtheta[link.j]);
        let T_i = link.transform_with(sin_cos[i], theta);
        let V_i = T_i.Ad() * V[link.parent].spin() + A * dq;
        let V_c = carrier_twist(&link, T_i, V_i, V, &mut carrier[..], i);
        let (V_i, dV_i) = V_i.classical_acceleration((V_c.ad() * (A * dq)).twist());  // velocity-product acceleration
        (T[i], V[i], dV[i]) = (T_i, V_i.twist(), dV_i);
        F[i]     = -(V_i.ad_transpose() * (link.G() * V_i));
        G_hat[i] = link.G().into();
    }
}

/// Inward from the tips: frees each joint and passes the remaining inertia and wrench to the parent.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn free_joints<const SIBLINGS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    let slots = model.links.len() + 1;
    let Workspace { T, dV, F, G_hat, U, u, pivots, .. } = workspace;
    let (T, dV, F) = (&T[..slots], &dV[..slots], &mut F[..slots]);
    let (G_hat, U, u) = (&mut G_hat[..slots], &mut U[..slots], &mut u[..slots]);
    for (i, link) in model.outward::<S>() {
        if SIBLINGS && model.first_sibling(i) == i {
            (U[i], pivots[link.j]) = (Wrench::zero(), S::from(model.armature[link.j]));
        }
    }
    for (i, link) in model.inward::<S>() {
        let (A, j, p) = (link.A(), link.j, link.parent);
        let (GA, moves_parent) = (G_hat[i] * A, p > 0 || model.is_floating());
        let first = if SIBLINGS { model.first_sibling(i) } else { 0 };
        if first > 0 {
            let (Ad, F_i) = (T[i].Ad(), G_hat[i].mul_add(dV[i], F[i]));
            U[first]   = Ad.transpose().mul_add(GA, U[first]);
            pivots[j]  += A * GA;
            ddtheta[j] += A * F_i;
            if moves_parent {
                G_hat[p] = G_hat[i].congruence_add(Ad, G_hat[p]);
                F[p]     = Ad.transpose().mul_add(F_i, F[p]);
            }
            if i == first {
                let (GA, one_over_d) = (U[i], S::one() / pivots[j]);
                u[i] = -ddtheta[j] * one_over_d;
                U[i] = GA * one_over_d;
                if moves_parent {
                    G_hat[p] = G_hat[p].minus_outer(GA, one_over_d);
                    F[p] += GA * u[i];
                }
            }
            continue;
        }
        let d  = A * GA + S::from(model.armature[j]);
        let one_over_d = S::one() / d;
        u[i] = -(ddtheta[j] + A * F[i]) * one_over_d;
        U[i] = GA * one_over_d;
        pivots[j] = d;
        if moves_parent {
            let G_a = G_hat[i].minus_outer(GA, one_over_d);
            let F_a = G_a.mul_add(dV[i], F[i] + GA * u[i]);
            let Ad = T[i].Ad();
            G_hat[p] = G_a.congruence_add(Ad, G_hat[p]);
            F[p]     = Ad.transpose().mul_add(F_a, F[p]);
        }
    }
}

/// Outward from the base: accelerations.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn accelerations<const SIBLINGS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    let slots = model.links.len() + 1;
    let Workspace { T, dV, U, u, .. } = workspace;
    let (T, dV, U, u) = (&T[..slots], &mut dV[..slots], &U[..slots], &u[..slots]);
    for (i, link) in model.outward::<S>() {
        let (dV_p, first) = (dV[link.parent], if SIBLINGS { model.first_sibling(i) } else { 0 });
        let dV_i = T[i].Ad() * dV_p + dV[i];
        if first == 0 {
            ddtheta[link.j] = u[i] - dV_i.dot(U[i]);
        } else if first == i {
            ddtheta[link.j] = u[i] - dV_p.dot(U[i]);
        }
        dV[i] = dV_i + link.A() * ddtheta[link.j];
    }
}

/// See [`forward_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamics;
impl Quantity for ForwardDynamics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics",
        "θ̈ = M⁻¹(τ − c − g − JᵀF − f), the accelerations that joint forces produce",
        &[THETA, DTHETA, TAU],
        &[output("ddtheta", VECTOR, ACCELERATION)],
    )
    .uses(Uses::ALL)
    .divides();
}
impl Kernel for ForwardDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, ..]) = (c.inputs, c.outputs);
        forward_dynamics(c.model, theta, dtheta, tau, c.environment, &mut c.memory.workspace, ddtheta);
    }
}
