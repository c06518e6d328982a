//! The two passes behind ∂τ and ∂θ̈, analytic (Carpentier and Mansard 2018; Singh, Russell and Wensing 2022).
//!
//! All twists and wrenches are in each link's **own frame**, whose z is the joint's axis. One frame for all would save
//! the transport of wrenches but lose digits: the moment of inertia of a slender link about its own joint becomes a
//! difference of large numbers, and ∂θ̈ divides by it. (Measured by `cargo xtask accuracy` on Tiago: 5·10⁵ units about
//! one origin, 350 in one frame's axes about each link's own origin, 12 in link frames.)
//!
//! A joint's axis A moves with its parent, whose motion is 𝒱_p and 𝒱̇_p, both seen from the link. So its rates are, θ̇
//! and θ̈ being per unit,
//!
//! > Ȧ = `[ad_𝒱_p]` A, Ä = `[ad_𝒱̇_p]` A + `[ad_𝒱_p]` Ȧ, and 𝒱 = 𝒱_p + A θ̇, 𝒱̇ = 𝒱̇_p + Ȧ θ̇ + A θ̈
//!
//! **Bodies beyond the joint.** A small motion of the joint carries all links beyond it along; the joints between them
//! do not change. Seen from such a link, in its own coordinates, which move too, its twist, its acceleration and the
//! wrench 𝓕 = 𝒢𝒱̇ − `[ad_𝒱]`ᵀ𝒢𝒱 change by
//!
//! > ∂𝒱 = Ȧ, ∂𝒱̇ = Ä − `[ad_𝒱]` Ȧ, ∂𝓕 = 𝒢 Ä + (−𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢) Ȧ − `[ad_Ȧ]`ᵀ 𝒢𝒱 = 𝒢 Ä + 𝓑 Ȧ, by θ
//! >
//! > ∂𝒱 = A, ∂𝒱̇ = D − `[ad_𝒱]` A, ∂𝓕 = 𝒢 D + 𝓑 A, by θ̇, with D = Ȧ + `[ad_𝒱_J]` A, 𝒱_J the twist of the link that the
//! > joint carries: 2 Ȧ for a joint of one axis
//! >
//! > ∂𝒱 = 0, ∂𝒱̇ = A, ∂𝓕 = 𝒢 A, by θ̈
//!
//! with 𝓑 = 𝒢̇ + H(𝒢𝒱), 𝒢̇ = −𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 the rate of an inertia and H(P)A = −`[ad_A]`ᵀP, skew. Half of 𝓑
//! cancels: it is `[[K, 0], [−2[f], 0]]`, K = İ − `[m]`, (m, f) = 𝒢𝒱. Seen from one frame, 𝒢, K, f and 𝓕 add up over
//! all links that the joint carries: 28 numbers, no 6 × 6 matrix. A wrench applied to a link is constant in its
//! coordinates and adds to 𝓕 alone.
//!
//! **Force of joint i**, τ_i = A_iᵀ𝓕ᶜ_i. If joint j is i itself or between i and the base, its motion carries both axis
//! and wrench along, and only ∂𝓕 of the bodies beyond i remains. If j is beyond i, only the bodies beyond j change, and
//! they move past axis i, which does not:
//!
//! > ∂τ_i/∂θ_j = A_iᵀ (𝒢ᶜ_i Ä_j + 𝓑ᶜ_i Ȧ_j), j at or before i; A_iᵀ (𝒢ᶜ_j Ä_j + 𝓑ᶜ_j Ȧ_j − `[ad_A_j]`ᵀ 𝓕ᶜ_j), j beyond
//! > i
//! >
//! > ∂τ_i/∂θ̇_j = A_iᵀ (𝒢ᶜ D_j + 𝓑ᶜ A_j), ∂τ_i/∂θ̈_j = A_iᵀ 𝒢ᶜ A_j, 𝒢ᶜ and 𝓑ᶜ of the outer one of the two
//!
//! The axes of one ball or free joint are carried together: for two of them, j is never beyond i.

use super::several_axes::add_moved_by_link;
use crate::kinematics::base_motion;
use crate::model::{Environment, Model};
use crate::scalar::{Scalar, pass};
use crate::spatial::{CoriolisFactor, Twist, Wrench, coriolis_moment};
use crate::workspace::{ByRates, ByTheta, Composite, Recursion, Workspace};

/// Adds d to the diagonal of ∂τ/∂θ̇.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_damping<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, d_dtheta: &mut [S]) {
    for (j, &damping) in model.damping.iter().enumerate() {
        d_dtheta[j * (model.n() + 1)] += S::from(damping);
    }
}

pass! {
/// The rates of the axes, and 𝒢, 𝓑 and 𝓕 of each link, from T_{i,i−1}(θ). With a motion `along`, which is X of the base
/// and the joints' rates x, X of each link and 𝒢X and 𝓑ᵀX in place of 𝒢 and 𝓑: see [`vjp.rs`](super::vjp).
pub(super) fn outward_pass<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], environment: &Environment<S>,
    along: Option<(Twist<S>, &[S])>, workspace: &mut Workspace<S>,
) {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len()]);
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { V, dV, F, .. }, .. } = workspace;

    // base: its own motion
    (V[0], dV[0]) = base_motion(model, theta, dtheta, ddtheta, environment);
    let G = model.base_inertia.map(S::from);
    let P = G * V[0];
    F[0] = G * dV[0] - V[0].ad().transpose() * P;
    match along {
        None => (workspace.composite.G[0], workspace.composite.B[0]) = (G, CoriolisFactor::new(G, V[0], P)),
        Some((X, _)) => {
            (workspace.recursion.X[0], workspace.composite.Q[0], workspace.composite.B[0].f) = (X, G * X, coriolis_moment(G, V[0], P.f, X));
        }
    }

    // base to tips: rates of the axes, twists, accelerations; 𝒢, 𝓑 and 𝓕 of each link
    let x = along.map(|(_, x)| x);
    match model.structure.of_one_axis {
        true => motions::<true, S, C>(model, dtheta, ddtheta, x, workspace),
        false => motions::<false, S, C>(model, dtheta, ddtheta, x, workspace),
    }
    let F = &mut workspace.recursion.F[..slots];
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;
    }
}
}

/// Outward from the base: the rates of the axes, twists and accelerations, 𝓕, and 𝒢 and 𝓑 or X, 𝒢X and 𝓑ᵀX of each
/// link.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn motions<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, dtheta: &[S], ddtheta: &[S], x: Option<&[S]>, workspace: &mut Workspace<S>,
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, V, dV, X, F, carrier, .. }, composite: Composite { Q, by_theta, by_rates, G: G_c, B, .. }, .. } = workspace;
    let (T, V, dV, F) = (&T[..slots], &mut V[..slots], &mut dV[..slots], &mut F[..slots]);
    let (by_theta, by_rates) = (&mut by_theta[..slots], &mut by_rates[..slots]);
    let (G_c, B, X, Q) = (&mut G_c[..slots], &mut B[..slots], &mut X[..slots], &mut Q[..slots]);
    for (i, link) in model.outward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (p, j, Ad) = (link.parent, link.j, T[i].Ad());
        let (V_p, dV_p) = (Ad * V[p], Ad * dV[p]);
        let [mut V_c, mut dV_c] = [V_p, dV_p];                               // of the link that carries the joint
        if !link.has_one_axis() {
            if link.is_next() {
                [V_c, dV_c] = [Ad * carrier[p][0], Ad * carrier[p][1]];
            }
            (carrier[i][0], carrier[i][1]) = (V_c, dV_c);
        }
        let A    = link.A();
        let dA   = (V_c.ad() * A).rate();
        let ddA  = V_c.ad() * dA + dV_c.ad() * A;
        let V_i  = V_p + link.A() * dtheta[link.j];
        let dV_i = dA.mul_add(dtheta[j], dV_p) + link.A() * ddtheta[link.j];
        let D    = if link.has_one_axis() { dA + dA } else { dA };
        (V[i], dV[i]) = (V_i, dV_i);
        (by_theta[i], by_rates[i]) = (ByTheta { r: ddA, s: dA.w }, ByRates { r: D, s: A.a });
        if !link.has_one_axis() && link.is_last {
            add_moved_by_link(model, i, T, V_i, by_rates);
        }
        let G = link.G();
        let P = G * V_i;
        F[i]  = G * dV_i - V_i.ad().transpose() * P;
        let Some(x) = x else {
            (G_c[i], B[i]) = (G, CoriolisFactor::new(G, V_i, P));
            continue;
        };
        let X_p = Ad * X[p];
        if !link.has_one_axis() {
            carrier[i][2] = if link.is_next() { Ad * carrier[p][2] } else { X_p };
        }
        let X_i = X_p + link.A() * x[link.j];
        (X[i], Q[i], B[i].f) = (X_i, G * X_i, coriolis_moment(G, V_i, P.f, X_i));
    }
}

pass! {
/// Adds θ̈ to quantities computed without it: 𝒱̇ of link i grows by 𝒱̇', the sum of Aθ̈ from the base on. So Ä grows by
/// `[ad_𝒱̇'_p]` A. 𝓕 of a composite body grows by 𝒢ᶜ𝒱̇'_p, and by 𝒢ᶜAθ̈ of its joint and of each joint beyond.
pub(super) fn add_accelerations<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, ddtheta: &[S], workspace: &mut Workspace<S>) {
    let Workspace { recursion: Recursion { T, dV, F, carrier, .. }, composite: Composite { dF, by_theta, G: G_c, .. }, .. } = workspace;
    dV[0] = match ddtheta.first_chunk() {
        Some(&dV) if model.is_floating() => Twist::from_array(dV),
        _ => Twist::zero(),
    };
    for (i, link) in model.outward::<S>() {
        let (Ad, p) = (T[i].Ad(), link.parent);
        let dV_p = Ad * dV[p];
        let mut dV_c = dV_p;
        if !link.has_one_axis() {
            if link.is_next() {
                dV_c = Ad * carrier[p][1];
            }
            carrier[i][1] = dV_c;
        }
        let ddA = &mut by_theta[i].r;
        *ddA = *ddA + dV_c.ad() * link.A();
        dV[i] = dV_p + link.A() * ddtheta[link.j];
        dF[i] = G_c[i] * link.A() * ddtheta[link.j];
    }
    dF[0] = Wrench::zero();
    for (i, link) in model.inward::<S>() {
        let (p, Ad, dF_i) = (link.parent, T[i].Ad(), dF[i]);
        F[i] += G_c[i] * (Ad * dV[p]) + dF_i;
        dF[p] = Ad.transpose().mul_add(dF_i, dF[p]);
    }
    F[0] += G_c[0] * dV[0] + dF[0];
}
}

pass! {
/// The links' part of the forces at the joints and a floating base, from the composite wrenches: τ_i = A_iᵀ𝓕ᶜ_i.
pub(super) fn joint_forces<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &Workspace<S>, tau: &mut [S]) {
    let Workspace { recursion: Recursion { F, .. }, .. } = workspace;
    tau.fill(S::zero());
    if model.is_floating() {
        tau[..6].copy_from_slice(&F[0].to_array());
    }
    for (i, link) in model.outward::<S>() {
        tau[link.j] += link.A() * F[i]; // (8.54)
    }
}
}
