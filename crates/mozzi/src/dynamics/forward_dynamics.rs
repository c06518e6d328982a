//! Forward dynamics: the articulated-body algorithm (Featherstone 2008, section 7.3), motions in the classical form of
//! `inverse_dynamics.rs`.

use super::armature::add_velocity_products;
use super::joint_friction::joint_friction;
use super::mass_matrix_solve::forward_dynamics_by_mass_matrix;
use super::several_axes::carrier_twist;
use super::siblings;
use super::spring_forces::add_spring_forces;
use crate::kinematics::{base_motion, joint_sines};
use crate::linalg::ldlt;
use crate::model::Error;
use crate::model::{Environment, Model};
use crate::quantities::{ACCELERATION, Call, DTHETA, Declaration, Kernel, Quantity, TAU, THETA, Uses, VECTOR, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench};
use crate::workspace::{Articulated, Recursion, Workspace};
use nalgebra::DVector;

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

pass! {
/// Ĝ and 𝓕 of each link are its articulated inertia and bias wrench, felt at its joint while all joints beyond it are
/// free.
fn articulated_bodies<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], tau: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, ddtheta: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    joint_sines(model, theta, workspace);
    let Workspace { recursion: Recursion { V, dV, F, .. }, articulated, vector, .. } = workspace;
    let Articulated { G_hat, u, .. } = articulated;
    vector.fill(S::zero());
    let (V_0, dV_0) = base_motion(model, theta, dtheta, vector, environment);
    let (V_0, dV_0) = V_0.classical_acceleration(dV_0);
    (V[0], dV[0]) = (V_0.twist(), dV_0);
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        F[0] = -(V_0.ad_transpose() * (G * V_0));
        G_hat[0] = G.into();
    }

    // τ − f, with ddtheta as memory for f
    for j in 0..model.n() { ddtheta[j] = joint_friction(model, j, dtheta[j]); }
    add_spring_forces(model, theta, ddtheta);
    add_velocity_products(model, dtheta, ddtheta);
    for j in 0..model.n() { u[j] = tau[j] - ddtheta[j]; }

    match model.structure.of_one_axis {
        true => motions::<true, S, C>(model, theta, dtheta, workspace),
        false => motions::<false, S, C>(model, theta, dtheta, workspace),
    }
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        workspace.recursion.F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;
    }
    let has_siblings = !model.structure.siblings.is_empty();
    if has_siblings { siblings::free_joints(model, workspace) } else { free_joints(model, workspace) }
    if model.is_floating() { free_base(tau, workspace, ddtheta); }
    if has_siblings { siblings::accelerations(model, workspace, ddtheta) } else { accelerations(model, workspace, ddtheta) }
}
}

/// Base to tips, with no joint accelerating: 𝒱 of each link, its velocity-product acceleration c, and its own 𝓕 and 𝒢.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn motions<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], workspace: &mut Workspace<S>,
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, V, F, carrier, sin_cos, .. }, articulated, .. } = workspace;
    let (T, V, F, sin_cos) = (&mut T[..slots], &mut V[..slots], &mut F[..slots], &sin_cos[..slots]);
    let (c, G_hat) = (&mut articulated.c[..slots], &mut articulated.G_hat[..slots]);
    for (i, link) in model.outward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (A, dq) = (link.A(), dtheta[link.j]);
        let T_i = link.transform_with(sin_cos[i], theta);                             // T_{i,i−1}(θ) (8.50)
        let V_i = T_i.Ad() * V[link.parent].spin() + A * dq;                          // (8.51)
        let V_c = carrier_twist(&link, T_i, V_i, V, &mut carrier[..], i);
        let (V_i, c_i) = V_i.classical_acceleration((V_c.ad() * (A * dq)).twist());   // (8.52)
        (T[i], V[i], c[i]) = (T_i, V_i.twist(), c_i);
        F[i]     = -(V_i.ad_transpose() * (link.G() * V_i));                          // (8.53)
        G_hat[i] = link.G().into();
    }
}

/// Tips to base: frees each joint, and hands the inertia and the wrench that are left to its parent.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn free_joints<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &mut Workspace<S>) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, F, .. }, articulated: Articulated { c, G_hat, U, u }, pivots: d, .. } = workspace;
    let (T, F, c, G_hat, U) = (&T[..slots], &mut F[..slots], &c[..slots], &mut G_hat[..slots], &mut U[..slots]);
    for (i, link) in model.inward::<S>() {
        let (A, j, p) = (link.A(), link.j, link.parent);
        let GA = G_hat[i] * A;
        d[j] = A * GA + S::from(model.armature[j]);                                   // d = AᵀĜA + armature
        let one_over_d = S::one() / d[j];
        u[j] = (u[j] - A * F[i]) * one_over_d;                                        // u = (τ − f − Aᵀ𝓕)/d
        U[i] = GA * one_over_d;                                                       // U = ĜA/d
        if p > 0 || model.is_floating() {
            let G_a = G_hat[i].minus_outer(GA, one_over_d);                           // Ĝᵃ = Ĝ − ĜA(ĜA)ᵀ/d
            let F_a = G_a.mul_add(c[i], F[i] + GA * u[j]);                            // 𝓕ᵃ = 𝓕 + Ĝᵃc + ĜAu
            let Ad = T[i].Ad();
            G_hat[p] = G_a.congruence_add(Ad, G_hat[p]);                              // Ĝ_p += AdᵀĜᵃAd
            F[p]     = Ad.transpose().mul_add(F_a, F[p]);                             // 𝓕_p += Adᵀ𝓕ᵃ
        }
    }
}

/// The acceleration of a floating base: Ĝ𝒱̇ = 𝓕_τ − 𝓕, all joints being free.
#[cfg_attr(not(debug_assertions), inline(always))]
fn free_base<S: Scalar>(tau: &[S], workspace: &mut Workspace<S>, ddtheta: &mut [S]) {
    let Workspace { recursion: Recursion { dV, F, .. }, articulated: Articulated { G_hat, .. }, pivots, .. } =
        workspace;
    let Some(&F_tau) = tau.first_chunk() else { return };
    let needed = Wrench::from_array(F_tau) - F[0] - G_hat[0] * dV[0];
    let (ddbase, base_pivots) = ldlt::solve_6(G_hat[0].to_matrix(), needed.to_array());
    pivots[..6].copy_from_slice(&base_pivots);
    ddtheta[..6].copy_from_slice(&ddbase);
    dV[0] += Twist::from_array(ddbase);
}

/// Base to tips: the accelerations.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn accelerations<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &mut Workspace<S>, ddtheta: &mut [S]) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, dV, .. }, articulated: Articulated { c, U, u, .. }, .. } = workspace;
    let (T, dV, c, U) = (&T[..slots], &mut dV[..slots], &c[..slots], &U[..slots]);
    for (i, link) in model.outward::<S>() {
        let dV_i = T[i].Ad() * dV[link.parent] + c[i];
        ddtheta[link.j] = u[link.j] - dV_i.dot(U[i]);                                 // θ̈ = u − Uᵀ𝒱̇
        dV[i] = dV_i + link.A() * ddtheta[link.j];                                    // 𝒱̇ += Aθ̈ (8.52)
    }
}

/// See [`forward_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamics;
#[doc(hidden)]
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
#[doc(hidden)]
impl Kernel for ForwardDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, ..]) = (c.inputs, c.outputs);
        forward_dynamics(c.model, theta, dtheta, tau, c.environment, &mut c.memory.workspace, ddtheta);
    }
}

impl Model<f64> {
    /// θ̈ from τ: by articulated bodies, or by the mass matrix (see
    /// [`solves_by_mass_matrix`](Self::solves_by_mass_matrix)). See
    /// [`forward_dynamics`](forward_dynamics()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.vector(ForwardDynamics, &[theta, dtheta, tau], environment)
    }
}
