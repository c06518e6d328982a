//! The two passes behind ∂τ and ∂θ̈, analytic (Carpentier and Mansard 2018; Singh, Russell and Wensing 2022).
//!
//! All twists and wrenches are in each link's **own frame**, whose z is the joint's axis. One frame for all would save the transport of wrenches, and
//! lose digits: the moment of inertia of a slender link about its own joint becomes a difference of large numbers, and ∂θ̈ divides by it. (Measured by
//! `cargo xtask accuracy` on Tiago: 5·10⁵ units about one origin, 350 in one frame's axes about each link's own origin, 12 in link frames.)
//!
//! A joint's axis A is carried by its parent, which moves with 𝒱_p and 𝒱̇_p, both seen from the link. So its rates are, θ̇ and θ̈ being per unit,
//!
//! > Ȧ = `[ad_𝒱_p]` A, Ä = `[ad_𝒱̇_p]` A + `[ad_𝒱_p]` Ȧ, and 𝒱 = 𝒱_p + A θ̇, 𝒱̇ = 𝒱̇_p + Ȧ θ̇ + A θ̈
//!
//! **What a body beyond the joint sees.** A small motion of the joint carries all links beyond it along, without a change of
//! the joints between them. Seen from such a link, whose own coordinates are carried too, its twist, its acceleration and the
//! wrench 𝓕 = 𝒢𝒱̇ − `[ad_𝒱]`ᵀ𝒢𝒱 change by
//!
//! > ∂𝒱 = Ȧ, ∂𝒱̇ = Ä − `[ad_𝒱]` Ȧ, ∂𝓕 = 𝒢 Ä + (−𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢) Ȧ − `[ad_Ȧ]`ᵀ 𝒢𝒱 = 𝒢 Ä + 𝓑 Ȧ, by θ
//! >
//! > ∂𝒱 = A, ∂𝒱̇ = D − `[ad_𝒱]` A, ∂𝓕 = 𝒢 D + 𝓑 A, by θ̇, with D = Ȧ + `[ad_𝒱_J]` A, 𝒱_J the twist of the link that the joint carries: 2 Ȧ for a joint of one axis
//! >
//! > ∂𝒱 = 0, ∂𝒱̇ = A, ∂𝓕 = 𝒢 A, by θ̈
//!
//! with 𝓑 = 𝒢̇ + H(𝒢𝒱), 𝒢̇ = −𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 the rate of an inertia and H(P)A = −`[ad_A]`ᵀP, skew. Half of 𝓑 cancels: it is
//! `[[K, 0], [−2[f], 0]]`, K = İ − `[m]`, (m, f) = 𝒢𝒱. Seen from one frame, 𝒢, K, f and 𝓕 add up over all that
//! hangs from the joint: 28 numbers, no 6 × 6 matrix. A wrench that is applied to a link is constant in its coordinates and adds to
//! 𝓕 alone.
//!
//! **What a joint i carries**, τ_i = A_iᵀ𝓕ᶜ_i. By a joint j at i or between it and the base, axis and wrench are both carried, and what is
//! left is ∂𝓕 of the bodies beyond i. By a joint j beyond i, they are the bodies beyond j that change, and are carried past an axis that is not:
//!
//! > ∂τ_i/∂θ_j = A_iᵀ (𝒢ᶜ_i Ä_j + 𝓑ᶜ_i Ȧ_j), j at or before i; A_iᵀ (𝒢ᶜ_j Ä_j + 𝓑ᶜ_j Ȧ_j − `[ad_A_j]`ᵀ 𝓕ᶜ_j), j beyond i
//! >
//! > ∂τ_i/∂θ̇_j = A_iᵀ (𝒢ᶜ D_j + 𝓑ᶜ A_j), ∂τ_i/∂θ̈_j = A_iᵀ 𝒢ᶜ A_j, 𝒢ᶜ and 𝓑ᶜ of the outer one of the two
//!
//! The axes of one ball or free joint are carried together: for two of them, j is never beyond i.

use crate::kinematics::{base_motion, base_pose};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Rates;
use crate::model::{Environment, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::{CoriolisFactor, Twist, Wrench};

/// The derivatives, those by θ̇ and θ̈ where asked for; the workspace holds T_{i,i−1}(θ), and afterwards no more.
#[cfg_attr(not(test), inline(always))]
#[allow(clippy::too_many_arguments)]
pub(super) fn derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    d_theta: &mut [S],
    by_rates: Option<[&mut [S]; 2]>,
) {
    outward_pass(model, theta, dtheta, ddtheta, environment, workspace);
    let (d_dtheta, M) = by_rates.map_or((None, None), |[d_dtheta, M]| (Some(d_dtheta), Some(M)));
    inward_pass(model, theta, environment, workspace, true, [Some(d_theta), d_dtheta, M]);
}

/// The rates of the axes, and 𝒢, 𝓑 and 𝓕 of each link, from T_{i,i−1}(θ).
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip] // one equation a line
pub(super) fn outward_pass<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], environment: &Environment<S>, workspace: &mut Workspace<S>,
) {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len()]);
    let slots = model.links.len() + 1;
    let Workspace { T, V, dV, F, carrier, axes, G_c, B, .. } = workspace;
    let (T, V, dV, F) = (&mut T[..slots], &mut V[..slots], &mut dV[..slots], &mut F[..slots]);
    let (axes, G_c, B) = (&mut axes[..slots], &mut G_c[..slots], &mut B[..slots]);

    // base: its own motion
    (V[0], dV[0]) = base_motion(model, theta, dtheta, ddtheta, environment);
    let G = model.base_inertia.map(S::from);
    let P = G * V[0];
    (G_c[0], B[0]) = (G, CoriolisFactor::new(G, V[0], P));
    F[0] = G * dV[0] - V[0].ad().transpose() * P;

    // base to tips: rates of the axes, twists, accelerations; 𝒢, 𝓑 and 𝓕 of each link
    for (i, link) in model.outward::<S>() {
        let (p, j, Ad) = (link.parent, link.j, T[i].Ad());
        let (V_p, dV_p) = (Ad * V[p], Ad * dV[p]);
        let [mut V_c, mut dV_c] = [V_p, dV_p];                               // of the link that carries the joint
        if !link.has_one_axis() {
            if link.is_next() {
                [V_c, dV_c] = carrier[p].map(|V| Ad * V);
            }
            carrier[i] = [V_c, dV_c];
        }
        let A    = link.unit();
        let dA   = (V_c.ad() * A).twist();
        let ddA  = V_c.ad() * dA + dV_c.ad() * A;
        let V_i  = V_p + link.A() * link.rate(dtheta);
        let dV_i = dA.mul_add(dtheta[j], dV_p) + link.A() * link.rate(ddtheta);
        (V[i], dV[i], axes[i]) = (V_i, dV_i, Rates { dA: dA.w, ddA, D: dA + dA });
        if !link.has_one_axis() && link.is_last {
            several_axes(model, i, T, V, axes);
        }
        let G = link.G();
        let P = G * V_i;
        (G_c[i], B[i]) = (G, CoriolisFactor::new(G, V_i, P));
        F[i]  = G * dV_i - V_i.ad().transpose() * P;
    }
    for &(frame, F_b) in environment.applied {
        let frame = model.frame_at::<S>(frame);
        F[frame.slot] += frame.T.inverse().Ad().transpose() * F_b;
    }
}

/// Adds θ̈ to what was carried and filled without: 𝒱̇ of link i grows by 𝒱̇', the sum of Aθ̈ from the base on. So Ä grows by `[ad_𝒱̇'_p]` A,
/// and 𝓕 of a composite body by 𝒢ᶜ𝒱̇'_p, and 𝒢ᶜAθ̈ of its joint and of each beyond.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub(super) fn add_accelerations<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, ddtheta: &[S], workspace: &mut Workspace<S>) {
    let Workspace { T, dV, F, U, carrier, axes, G_c, .. } = workspace;
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
        let ddA = &mut axes[i].ddA;
        *ddA = *ddA + dV_c.ad() * link.unit();
        dV[i] = dV_p + link.A() * link.rate(ddtheta);
        U[i]  = U[i] * ddtheta[link.j];
    }
    U[0] = Wrench::zero();
    for (i, link) in model.inward::<S>() {
        let (p, Ad, U_i) = (link.parent, T[i].Ad(), U[i]);
        F[i] += G_c[i] * (Ad * dV[p]) + U_i;
        U[p] = Ad.transpose().mul_add(U_i, U[p]);
    }
    F[0] += G_c[0] * dV[0] + U[0];
}

/// ∂τ/∂θ, ∂τ/∂θ̇ and M, what is asked for. Tips to base, 𝒢, 𝓑 and 𝓕 of a link become those of the link with all that hangs from it; `carried`
/// says that they are so far those of links.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub(super) fn inward_pass<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], environment: &Environment<S>, workspace: &mut Workspace<S>, carried: bool,
    [mut d_theta, mut d_dtheta, mut M]: [Option<&mut [S]>; 3],
) {
    let n = model.n();
    let Workspace { T, V, F, U, axes, G_c, B, .. } = workspace;
    if let Some(d_theta) = &mut d_theta {
        zero(model, d_theta);
    }
    if let Some(d_dtheta) = &mut d_dtheta {
        zero(model, d_dtheta);
        for j in 0..n {
            d_dtheta[j * n + j] = S::from(model.damping[j]);
        }
    }
    if let Some(M) = &mut M {
        zero(model, M);
        for j in 0..n {
            M[j * n + j] = S::from(model.armature[j]);
        }
    }
    // {s}, which carries the axes of a floating base, seen from it
    let Ad = base_pose(model, theta).inverse().Ad();
    let (V_s, dV_s) = (Ad * environment.base_twist, Ad * environment.proper_base_acceleration());

    for (i, link) in model.inward::<S>() {
        let (j, A, Rates { dA, ddA, D }, G_i, B_i) = (link.j, link.unit(), axes[i], G_c[i], B[i]);
        let mut GA = G_i * A;
        let U_i = GA;
        let mut column  = G_i * ddA + B_i * dA - A.ad_transpose(F[i]);       // ∂𝓕 by θ_j, felt below joint i
        let mut dcolumn = G_i * D + B_i * A;                                 // by θ̇_j
        let mut BtA = B_i.transpose_mul(A);                                  // 𝓑ᵀA, a moment
        if let Some(d_theta) = &mut d_theta {
            d_theta[j * n + j] += A * column;
            if !link.has_one_axis() && link.is_next() {
                carried_together(model, i, T, A.ad_transpose(F[i]), d_theta);
            }
        }
        if let Some(d_dtheta) = &mut d_dtheta {
            d_dtheta[j * n + j] += A * dcolumn;
        }
        if let Some(M) = &mut M {
            M[j * n + j] += A * GA;
        }
        let mut above = i;
        for (k, below) in model.to_base::<S>(link.parent) {
            let Ad = T[above].Ad().transpose();
            (column, dcolumn, GA, BtA) = (Ad * column, Ad * dcolumn, Ad * GA, T[above].R.inverse_mul(BtA));
            above = k;
            let (A, Rates { dA, ddA, D }) = (below.unit(), axes[k]);
            let (ij, ji) = (below.j * n + j, j * n + below.j);
            if let Some(d_theta) = &mut d_theta {
                d_theta[ij] += A * column;
                d_theta[ji] += ddA.dot(GA) + dA.dot(BtA);
            }
            if let Some(d_dtheta) = &mut d_dtheta {
                d_dtheta[ij] += A * dcolumn;
                d_dtheta[ji] += D.dot(GA) + A.a * BtA.0[2];
            }
            if let Some(M) = &mut M {
                let entry = A * GA;
                M[ij] += entry;
                M[ji] += entry;
            }
        }
        if model.is_floating() {
            let Ad = T[above].Ad().transpose();
            (column, dcolumn, GA, BtA) = (Ad * column, Ad * dcolumn, Ad * GA, T[above].R.inverse_mul(BtA));
            let BtA = Wrench { m: BtA, f: Vec3::zero() };
            let (s_t, ds_t) = (V_s.ad().transpose(), dV_s.ad().transpose());
            let row  = ds_t * GA + s_t * (s_t * GA + BtA);                   // (𝒢A)ᵀÄ_e + (𝓑ᵀA)ᵀȦ_e for each e
            let drow = (V_s + V[0]).ad().transpose() * GA + BtA;
            if let Some(d_theta) = &mut d_theta {
                add_cross(d_theta, n, j, column, row);
            }
            if let Some(d_dtheta) = &mut d_dtheta {
                add_cross(d_dtheta, n, j, dcolumn, drow);
            }
            if let Some(M) = &mut M {
                add_cross(M, n, j, GA, GA);
            }
        }
        if carried {
            U[i] = U_i;
        }
        if carried && (link.parent > 0 || model.is_floating()) {
            let (p, Ad, F_i) = (link.parent, T[i].Ad(), F[i]);
            G_c[p] = G_i.congruence_add(Ad, G_c[p]);
            B[p]  += B_i.congruence(Ad);
            F[p]   = Ad.transpose().mul_add(F_i, F[p]);
        }
    }

    // a floating base: the axes e
    if model.is_floating() {
        let (G, B) = (G_c[0], B[0]);
        for (r, e) in Twist::axes().into_iter().enumerate() {
            let de = V_s.ad() * e;
            if let Some(d_theta) = &mut d_theta {
                set_column(d_theta, n, r, G * (dV_s.ad() * e + V_s.ad() * de) + B * de.w);
            }
            if let Some(d_dtheta) = &mut d_dtheta {
                set_column(d_dtheta, n, r, G * (de + V[0].ad() * e) + B * e.w);
            }
            if let Some(M) = &mut M {
                set_column(M, n, r, G * e);
            }
        }
    }
}

/// D of a ball's or a free joint's axes, whose last is i: `[ad_𝒱_J]` A once, instead of Ȧ twice, 𝒱_J seen from each axis.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
fn several_axes<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, i: usize, T: &[SE3<S>], V: &[Twist<S>], axes: &mut [Rates<S>],
) {
    let (mut k, mut V_J) = (i, V[i]);
    loop {
        let link = model.link::<S>(k);
        let D = &mut axes[k].D;
        *D = *D * S::from_f64(0.5) + (V_J.ad() * link.unit()).twist();
        if !link.is_next() {
            break;
        }
        (k, V_J) = (link.parent, T[k].inverse().Ad() * V_J);
    }
}

/// Takes back, between axis i and those before it of one joint, that what axis i carries is carried past them: W = `[ad_A]`ᵀ𝓕ᶜ.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
fn carried_together<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, i: usize, T: &[SE3<S>], W: Wrench<S>, d_theta: &mut [S],
) {
    let (n, j, mut above, mut W) = (model.n(), model.links[i - 1].j, i, W);
    for (k, below) in model.to_base::<S>(model.links[i - 1].parent) {
        W = T[above].Ad().transpose() * W;
        d_theta[below.j * n + j] += below.unit() * W;
        if !below.is_next() {
            break;
        }
        above = k;
    }
}

/// What joints and a floating base carry of what was carried, as far as links make it: τ_i = A_iᵀ𝓕ᶜ_i.
#[cfg_attr(not(test), inline(always))]
pub(super) fn joint_forces<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &Workspace<S>, tau: &mut [S]) {
    let Workspace { F, .. } = workspace;
    tau.fill(S::zero());
    if model.is_floating() {
        tau[..6].copy_from_slice(&F[0].to_array());
    }
    for (i, link) in model.outward::<S>() {
        tau[link.j] += link.ratio() * (link.A() * F[i]);
    }
}

/// n × n zeros.
#[cfg_attr(not(test), inline(always))]
#[track_caller]
fn zero<S: Scalar, C: Scalar>(model: &Model<C>, X: &mut [S]) {
    let n = model.n();
    assert!(X.len() == n * n, "a derivative has {} entries, expected n² = {}", X.len(), n * n);
    X.fill(S::zero());
}

/// Column j and row j at a floating base's six.
#[cfg_attr(not(test), inline(always))]
fn add_cross<S: Scalar>(X: &mut [S], n: usize, j: usize, column: Wrench<S>, row: Wrench<S>) {
    for (r, (column, row)) in column.to_array().into_iter().zip(row.to_array()).enumerate() {
        X[r * n + j] += column;
        X[j * n + r] += row;
    }
}

/// A column of a floating base's 6 × 6 block.
#[cfg_attr(not(test), inline(always))]
fn set_column<S: Scalar>(X: &mut [S], n: usize, r: usize, column: Wrench<S>) {
    for (s, entry) in column.to_array().into_iter().enumerate() {
        X[s * n + r] = entry;
    }
}
