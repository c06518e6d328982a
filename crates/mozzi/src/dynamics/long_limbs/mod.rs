//! ∂θ̈ by articulated bodies, for robots with long limbs: O(n²), and ∂τ is not computed.
//!
//! Column j of M⁻¹∂τ/∂θ is the response of the joints to wrenches. Each link k beyond joint j feels 𝒢_k r_j + 𝓑_k
//! s_j, and j's parent −`[ad_A_j]`ᵀ𝓕ᶜ_j, for the wrench at the joint moves past the axes before it
//! (`derivatives.rs`). By θ̇ it is the same with another pair (r, s) and without 𝓕ᶜ. Column j of M⁻¹ is the response
//! to a unit force at joint j.
//!
//! **Inward, once for all columns.** While the joints beyond link i are free, the wrenches of (r, s) on all links
//! from i on have the effect of Ĝ_i r + 𝓑̂_i s on link i alone. Ĝ is the articulated inertia (Featherstone 2008,
//! section 7.3), because a rigid acceleration r is an acceleration of link i; 𝓑̂ follows the rule of a bias wrench:
//!
//! > d = AᵀĜA + armature, U = ĜA/d, y = 𝓑̂ᵀA/d, 𝓑̂_p = 𝓑_p + Σ (𝓑̂ − d U yᵀ)
//!
//! **Outward, once for all columns.** Φ is the acceleration of a link by a wrench on it while all joints are free, the
//! inverse of its operational-space inertia (Kreutz-Delgado, Jain and Rodriguez 1992). With Φ_p of the parent
//!
//! > Φ = (1 − A Uᵀ) Φ_p (1 − U Aᵀ) + A Aᵀ/d; at a fixed base 0, at a floating base Ĝ⁻¹
//!
//! For the joints from the base up to j, column j is the wrench Q_j = Ĝr + 𝓑̂s − `[ad_A]`ᵀ𝓕ᶜ on link j, whose
//! acceleration is therefore −ΦQ.
//!
//! **Columns go outward** from link j (`articulated_columns.rs`), with a + r as one variable. They need not go inward:
//! joint i responds to a wrench on link j as link j does to a force at joint i, which is column i of M⁻¹. So
//!
//! > x = −Uᵀ(a_p + r) − yᵀs, a = a_p + A x, and X_ij = x for i beyond j; else X_ij = −aᵀQ_j, a of column i of M⁻¹
//!
//! That is 72 products for each pair of joints, for its six entries; solving M X = −∂τ by articulated bodies takes 207,
//! and ∂τ.
//!
//! A joint's own stiffness and damping, and between the axes of one ball or free joint the terms in which they differ
//! from axes of several joints, are a block on the diagonal of ∂τ, which multiplies M⁻¹.
//!
//! Inertias are in link frames, where a slender link keeps its digits. All else is in the base's axes, about each
//! link's own origin, so that a step to a parent or a child is a shift.

mod columns;

use super::armature::add_velocity_product_rates;
use super::base_rates::BaseRates;
use super::derivatives::{add_damping, outward_pass};
use super::several_axes::carried_together;
use super::spring_forces::add_stiffness;
use crate::lie::SO3;
use crate::linalg::{Mat3, Square, Vec3, ldlt};
use crate::model::{Environment, Freedom, Model};
use crate::scalar::{Scalar, pass};
use crate::spatial::{CoriolisFactor, Twist, Wrench};
use crate::workspace::{Articulated, ByRates, ByTheta, Composite, LongLimbs, Recursion, Turned, W, Workspace};
use columns::{add, columns_of_base, columns_of_joints, product, shift_rows, times};

pass! {
/// Fills the matrices, n × n by rows, with ∂θ̈/∂θ, ∂θ̈/∂θ̇ and M⁻¹. Requires T and the factors of forward dynamics in
/// the workspace.
pub(super) fn derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, matrices: [&mut [S]; 3],
) {
    let ([X, Y, inverse], n) = (matrices, model.n());
    for matrix in [&*X, &*Y, &*inverse] {
        assert!(matrix.len() == n * n, "a matrix has {} entries, expected n² = {}", matrix.len(), n * n);
    }
    let mut limbs = workspace.long_limbs.take().unwrap_or_else(|| LongLimbs::new(model));
    outward_pass(model, theta, dtheta, ddtheta, environment, None, workspace);
    let rates = BaseRates::of_derivatives(model, theta, environment, workspace);

    // the blocks of the joints' own terms, at their places in ∂τ
    for place in model.places() {
        for j in place.velocities() {
            for matrix in [&mut *X, &mut *Y] {
                matrix[j * n..][place.velocities()].fill(S::zero());
            }
        }
    }
    add_stiffness(model, theta, X);
    add_damping(model, Y);
    add_velocity_product_rates(model, dtheta, Y);
    inward(model, workspace, &mut limbs, X);
    take_blocks(model, &mut limbs, [X, Y]);
    outward(model, workspace, &mut limbs);

    let mut matrices = [inverse, X, Y];
    if model.is_floating() {
        columns_of_base(model, rates, &mut limbs, &mut matrices);
    }
    for first in (1..=model.links.len()).step_by(W) {
        columns_of_joints(model, first, &mut limbs, &mut matrices);
    }
    let [inverse, X, Y] = matrices;
    multiply_blocks(model, &limbs, inverse, [X, Y]);
    workspace.long_limbs = Some(limbs);
}
}

/// Base to tips: the links' axes and pairs in the base's axes.
#[cfg_attr(not(debug_assertions), inline(always))]
fn turn<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &Workspace<S>, turned: &mut [Turned<S>]) {
    let Workspace { recursion: Recursion { T, .. }, composite: Composite { by_theta, by_rates, .. }, .. } = workspace;
    turned[0].R = SO3::identity();
    for (i, link) in model.outward::<S>() {
        let R = turned[link.parent].R * T[i].R.inverse();
        let turn = |V: Twist<S>| Twist { w: R * V.w, v: R * V.v };
        let (ByTheta { r: by_theta, s: [x, y] }, ByRates { r: by_rates, s: z }) = (by_theta[i], by_rates[i]);
        turned[i] = Turned {
            R,
            p: R * T[i].p,
            A: turn(link.A().twist()),
            by_theta: (turn(by_theta), R * Vec3([x, y, S::zero()])),
            by_rates: (turn(by_rates.twist()), R * Vec3([S::zero(), S::zero(), z])),
        };
    }
}

/// Tips to base: U, 𝓑̂, y and Q of each link.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn inward<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, limbs: &mut LongLimbs<S>, X: &mut [S],
) {
    let slots = model.links.len() + 1;
    turn(model, workspace, &mut limbs.turned);
    let mut X = Square::new(model.n(), X);
    let Workspace { recursion: Recursion { T, F, .. }, composite: Composite { B, .. }, articulated: Articulated { G_hat, U, .. }, pivots, .. } = workspace;
    let (T, by_theta, by_rates) = (&T[..slots], &workspace.composite.by_theta[..slots], &workspace.composite.by_rates[..slots]);
    let LongLimbs { turned, passed, sources, .. } = limbs;
    let (turned, passed, sources) = (&turned[..slots], &mut passed[..slots], &mut sources[..slots]);
    for i in 0..slots {
        sources[i].B_hat = columns(B[i], turned[i].R.matrix());
    }
    for (i, link) in model.inward::<S>() {
        let (p, j) = (link.parent, link.j);
        let Turned { R, p: to_parent, A, by_theta: (_, s), by_rates: (_, s_rates) } = turned[i];
        let turned = |F: Wrench<S>| Wrench { m: R * F.m, f: R * F.f };
        let (U_i, B_hat) = (turned(U[i]), sources[i].B_hat);
        let dy = [A.dot(B_hat[0]), A.dot(B_hat[1]), A.dot(B_hat[2])];
        let one_over_d = S::one() / pivots[j];
        let moved = link.A().ad_transpose(F[i]);
        if link.is_next() {
            carried_together(model, i, T, moved, &mut X);
        }
        let Q = turned(G_hat[i] * by_theta[i].r - moved) + product(B_hat, s);
        let Q_rates = turned(G_hat[i] * by_rates[i].r.twist()) + product(B_hat, s_rates);
        let now = &mut passed[i];
        (now.A, now.p) = (A.to_array(), to_parent.0);
        now.minus_U = (-U_i.about(to_parent)).to_array();
        now.minus_y = [-(dy[0] * one_over_d), -(dy[1] * one_over_d), -(dy[2] * one_over_d)];
        now.minus_Q = [(-Q).to_array(), (-Q_rates).to_array()];
        if p > 0 || model.is_floating() {
            for k in 0..3 {
                sources[p].B_hat[k] += (B_hat[k] - U_i * dy[k]).about(to_parent);
            }
            F[p] = T[i].Ad().transpose().mul_add(F[i], F[p]);
        }
    }
}

/// The columns of 𝓑 in the base's axes.
#[cfg_attr(not(debug_assertions), inline(always))]
fn columns<S: Scalar>(B: CoriolisFactor<S>, R: Mat3<S>) -> [Wrench<S>; 3] {
    let (K, f) = ((R * B.K * R.transpose()).transpose(), R * (B.f + B.f));
    let ([x, y, z], o) = (f.0, S::zero());
    [
        Wrench { m: K.x, f: Vec3([o, -z, y]) },
        Wrench { m: K.y, f: Vec3([z, o, -x]) },
        Wrench { m: K.z, f: Vec3([-y, x, o]) },
    ]
}

/// Keeps the joints' own terms: X and Y have them at their places in ∂τ.
#[cfg_attr(not(debug_assertions), inline(always))]
fn take_blocks<S: Scalar, C: Scalar>(model: &Model<C>, limbs: &mut LongLimbs<S>, [X, Y]: [&[S]; 2]) {
    let n = model.n();
    for place in model.places() {
        for j in place.velocities() {
            limbs.passed[j + model.links.len() + 1 - n].minus_e = [-X[j * (n + 1)], -Y[j * (n + 1)]];
        }
        if place.freedom != Freedom::One {
            for j in place.velocities() {
                for (c, k) in place.velocities().enumerate() {
                    limbs.blocks[j][0][c] = X[j * n + k];
                    limbs.blocks[j][1][c] = Y[j * n + k];
                }
            }
        }
    }
}

/// Multiplies M⁻¹ by the entries of the blocks off the diagonal, and subtracts.
#[cfg_attr(not(debug_assertions), inline(always))]
fn multiply_blocks<S: Scalar, C: Scalar>(
    model: &Model<C>,
    limbs: &LongLimbs<S>,
    inverse: &[S],
    matrices: [&mut [S]; 2],
) {
    let n = model.n();
    for place in model.places().iter().filter(|place| place.freedom != Freedom::One) {
        for i in 0..n {
            for j in place.velocities() {
                for (c, k) in place.velocities().enumerate().filter(|&(_, k)| k != j) {
                    for m in 0..2 {
                        let entry = &mut matrices[m][i * n + k];
                        *entry = inverse[i * n + j].mul_add(-limbs.blocks[j][m][c], *entry);
                    }
                }
            }
        }
    }
}

/// Base to tips: Φ of each link, and the accelerations with which its columns start.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn outward<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &Workspace<S>, limbs: &mut LongLimbs<S>) {
    let slots = model.links.len() + 1;
    let (Workspace { articulated: Articulated { G_hat, .. }, pivots, .. }, LongLimbs { turned, passed, sources, .. }) = (workspace, limbs);
    let (turned, passed, sources) = (&turned[..slots], &passed[..slots], &mut sources[..slots]);
    sources[0].Phi = if model.is_floating() { inverse_6(G_hat[0].to_matrix()) } else { [[S::zero(); 6]; 6] };
    for (i, link) in model.outward::<S>() {
        let (at, mut Phi) = (&passed[i], sources[link.parent].Phi);
        // a force at the joint
        let mut a_p = times(&Phi, at.minus_U);
        let x = dot(at.minus_U, a_p) + S::one() / pivots[link.j];
        shift(&mut a_p, at.p);
        let mut a = a_p;
        add(&mut a, x, at.A);
        // about the link's origin: columns, then rows
        for row in &mut Phi {
            shift(row, at.p);
        }
        shift_rows(&mut Phi, at.p);
        for r in 0..6 {
            add(&mut Phi[r], at.A[r], a);
            add(&mut Phi[r], a_p[r], at.A);
        }
        make_symmetric(&mut Phi); // rounding errors of the skew part would add up from link to link
        let (mut by_theta, mut by_rates) = (turned[i].by_theta.0.to_array(), turned[i].by_rates.0.to_array());
        for r in 0..6 {
            add(&mut by_theta, at.minus_Q[0][r], Phi[r]);
            add(&mut by_rates, at.minus_Q[1][r], Phi[r]);
        }
        let now = &mut sources[i];
        (now.Phi, now.a, now.x) = (Phi, [a, by_theta, by_rates], x);
    }
}

/// A twist about the link's origin instead of the parent's: v + p × ω.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn shift<S: Scalar>(a: &mut [S; 6], [x, y, z]: [S; 3]) {
    let [f, g, h, ..] = *a;
    a[3] = z.mul_add(-g, y.mul_add(h, a[3]));
    a[4] = x.mul_add(-h, z.mul_add(f, a[4]));
    a[5] = y.mul_add(-f, x.mul_add(g, a[5]));
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn dot<S: Scalar>(a: [S; 6], b: [S; 6]) -> S {
    Twist::from_array(a).dot(Wrench::from_array(b))
}

/// A⁻¹ of a symmetric positive definite A.
#[cfg_attr(not(debug_assertions), inline(always))]
fn inverse_6<S: Scalar>(A: [[S; 6]; 6]) -> [[S; 6]; 6] {
    let mut inverse = [[S::zero(); 6]; 6];
    for r in 0..6 {
        let mut e = [S::zero(); 6];
        e[r] = S::one();
        inverse[r] = ldlt::solve_6(A, e).0;
    }
    make_symmetric(&mut inverse);
    inverse
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn make_symmetric<S: Scalar>(A: &mut [[S; 6]; 6]) {
    for r in 1..6 {
        for c in 0..r {
            A[r][c] = A[c][r];
        }
    }
}
