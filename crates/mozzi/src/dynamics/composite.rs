//! Composite rigid bodies: the one pass behind M, C, ∂τ and ∂θ̈ (Walker and Orin 1982; Featherstone 2008, section 6.2;
//! Echeandia and Wensing 2021; Singh, Russell and Wensing 2022).
//!
//! Each of these n × n matrices is the same form, with another pair of twists (r, s) for each axis:
//!
//! > X_ij = A_iᵀ (𝒢ᶜ r_j + 𝓑ᶜ s_j) for i and j on one path from the base to a tip, else 0
//!
//! with 𝒢ᶜ and 𝓑ᶜ of the outer one of i and j. A is a joint's screw axis, 𝒢ᶜ the composite inertia of its link and all
//! links beyond it, 𝓑ᶜ the sum of 𝓑 = 𝒢̇ + H(𝒢𝒱) (see [`CoriolisFactor`]).
//!
//! | X | r | s |
//! |---|---|---|
//! | M | A | 0 |
//! | C | `[ad_𝒱]` A, 𝒱 of the joint's link | ½ A |
//! | ∂τ/∂θ̇ | D | A |
//! | ∂τ/∂θ | Ä | Ȧ |
//!
//! D, Ȧ and Ä are explained in `derivatives.rs`; ∂τ_i/∂θ_j has one more term if j is beyond i. A mimic joint's axis is
//! multiplied by its ratio, and its entries are added to its source joint's.
//!
//! Bodies are in each link's own frame, whose z is the joint's axis: in one frame for all, the moment of inertia of a
//! slender link about its own joint becomes a difference of large numbers. [`Path`] moves a wrench from a link to the
//! base.

use super::armature::set_armature;
use super::path::{Abreast, BaseAxes, LinkFrames, Load, Pairs, Path, turn};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::{ByRates, Model, Row, Workspace};
use crate::scalar::{Four, Scalar};
use crate::spatial::{CoriolisFactor, SpatialInertia, Twist, Wrench};

/// The pairs (r, s) of the six axes e of a floating base, in its coordinates: r_e = `[ad_X]` e + `[ad_Y][ad_Y]` e and
/// s_e = σ e + `[ad_Y]` e.
#[derive(Clone, Copy)]
pub(super) struct BaseRates<S> {
    pub X: Twist<S>,
    /// None if it is 0.
    pub Y: Option<Twist<S>>,
    pub sigma: S,
}

impl<S: Scalar> BaseRates<S> {
    /// (r_e, s_e).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn of(&self, e: Twist<S>) -> (Twist<S>, Vec3<S>) {
        let (r, s) = (self.X.ad() * e, e.w * self.sigma);
        match self.Y {
            None => (r, s),
            Some(Y) => {
                let Ye = Y.ad() * e;
                (r + Y.ad() * Ye, s + Ye.w)
            }
        }
    }

    /// The six numbers r_eᵀ F + s_eᵀ m.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn dot(&self, F: Wrench<S>, m: Vec3<S>) -> Wrench<S> {
        let row = self.X.ad().transpose() * F + Wrench { m: m * self.sigma, f: Vec3::zero() };
        match self.Y {
            None => row,
            Some(Y) => row + Y.ad().transpose() * (Y.ad().transpose() * F + Wrench { m, f: Vec3::zero() }),
        }
    }
}

/// A matrix to fill.
pub(super) struct Filled<'x, S> {
    pub X: &'x mut [S],
    pub base: BaseRates<S>,
}

/// The matrices to fill; their pairs are in the workspace.
pub(super) struct Matrices<'x, S> {
    /// ∂τ/∂θ, which has the additional term `[ad_A]`ᵀ𝓕ᶜ of wrenches that move past axes.
    pub by_theta: Option<Filled<'x, S>>,
    /// ∂τ/∂θ̇ or C.
    pub by_rates: Option<Filled<'x, S>>,
    /// M, with the rotors' inertia.
    pub M: Option<&'x mut [S]>,
}

/// Options of the pass.
#[derive(Clone, Copy)]
pub(super) struct Does {
    /// Whether 𝓑 is accumulated over composite bodies; 𝒢 always is.
    pub adds_factors: bool,
    /// Whether the wrenches 𝓕 are accumulated too.
    pub adds_wrenches: bool,
    /// Whether 𝒢ᶜA is kept in `workspace.U`.
    pub keeps_columns: bool,
    /// Whether 𝒢, 𝓑 and 𝓕 are composite already, from an earlier pass.
    pub is_composite: bool,
}

/// Fills the matrices. The workspace holds T_{i,i−1}(θ) and, for each link, 𝒢, the pairs, 𝓑 and 𝓕, if the matrices need
/// them.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip] // one equation a line
pub(super) fn composite_pass<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, Matrices { mut by_theta, mut by_rates, mut M }: Matrices<S>, does: Does,
) {
    if let Some(Filled { X, .. }) = &mut by_theta {
        check_size(model, X);
        X.fill(S::zero());
    }
    if let Some(Filled { X, .. }) = &mut by_rates {
        check_size(model, X);
        X.fill(S::zero());
    }
    if let Some(M) = &mut M {
        check_size(model, M);
        set_armature(model, M);
    }
    let slots = model.links.len() + 1;
    let Workspace { T, F, U, turned, rows, G_c, B, .. } = workspace;
    let bodies = Bodies { T: &T[..slots], F: &mut F[..slots], U: &mut U[..slots], G: &mut G_c[..slots], B: &mut B[..slots] };
    let pairs = Pairs { by_theta: &workspace.by_theta[..slots], by_rates: &workspace.by_rates[..slots] };
    if S::IS_ONE && model.structure.is_deep {
        let taken = [by_theta.is_some(), by_rates.is_some()];
        turn(model, &T[..slots], pairs, taken, &mut turned[..slots], rows);
        let path = BaseAxes { links: &turned[..slots], rows, runs: &model.structure.runs, at_once: S::Four::at_once() };
        fill(model, path, pairs, bodies, [&mut by_theta, &mut by_rates], &mut M, does);
    } else {
        let frames = LinkFrames { T: &T[..slots], pairs };
        let has_columns = by_theta.is_some() || by_rates.is_some();
        match S::Four::at_once() {
            Some(at_once) if has_columns => {
                fill(model, Abreast { frames, at_once }, pairs, bodies, [&mut by_theta, &mut by_rates], &mut M, does);
            }
            _ => fill(model, frames, pairs, bodies, [&mut by_theta, &mut by_rates], &mut M, does),
        }
    }

    // a floating base: the axes e
    if model.is_floating() {
        let n = model.n();
        for (r, e) in Twist::axes().into_iter().enumerate() {
            if let Some(Filled { X, base }) = &mut by_theta {
                let (r_e, s_e) = base.of(e);
                set_column(X, n, r, G_c[0] * r_e + B[0] * s_e);
            }
            if let Some(Filled { X, base }) = &mut by_rates {
                let (r_e, s_e) = base.of(e);
                set_column(X, n, r, G_c[0] * r_e + B[0] * s_e);
            }
            if let Some(M) = &mut M {
                set_column(M, n, r, G_c[0] * e);
            }
        }
    }
}

/// Quantities of each link, accumulated to those of its composite body (the link and all links beyond it).
struct Bodies<'w, S> {
    T: &'w [SE3<S>],
    F: &'w mut [Wrench<S>],
    U: &'w mut [Wrench<S>],
    G: &'w mut [SpatialInertia<S>],
    B: &'w mut [CoriolisFactor<S>],
}

/// Fills the joints' entries, and their rows and columns at a floating base.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip] // one equation a line
fn fill<S: Scalar + From<C>, C: Scalar, P: Path<S>>(
    model: &Model<C>, path: P, pairs: Pairs<S>, bodies: Bodies<S>,
    [by_theta, by_rates]: [&mut Option<Filled<S>>; 2], M: &mut Option<&mut [S]>, does: Does,
) {
    let Bodies { T, F, U, G: G_c, B } = bodies;
    let n = model.n();
    for (i, link) in model.inward::<S>() {
        let (j, A, G_i, B_i) = (link.j, link.A(), G_c[i], B[i]);
        let (GA, BtA) = (G_i * A, B_i.transpose_mul(A));
        let (mut of_theta, mut of_rates) = (Wrench::zero(), Wrench::zero());
        if does.keeps_columns {
            U[i] = GA;
        }
        if let Some(Filled { X, .. }) = by_theta {
            of_theta = pairs.by_theta[i].column(G_i, B_i) - A.ad_transpose(F[i]);   // 𝓕ᶜ is carried past the axes below
            X[j * n + j] += A * of_theta;
            if link.is_next() {
                carried_together(model, i, T, A.ad_transpose(F[i]), X);
            }
        }
        if let Some(Filled { X, .. }) = by_rates {
            of_rates = pairs.by_rates[i].column(G_i, B_i);
            X[j * n + j] += A * of_rates;
        }
        if let Some(M) = M {
            M[j * n + j] += A * GA;
        }
        let mut carried = path.taken(i, Load { GA, BtA, of_theta, of_rates });
        let (mut above, mut way) = (i, model.to_base::<S>(link.parent));
        while let Some((k, below)) = way.next() {
            carried = path.carried(above, carried);
            let Load { GA, BtA, of_theta, of_rates } = path.load(carried);
            if let Some((run, row)) = path.row(k) {
                let (ij, ji) = (run.j * n + j, j * n + run.j);
                if let Some(Filled { X, .. }) = by_theta {
                    add_column(X, n, ij, path.forces(row, of_theta));
                    add_row(X, ji, Row::products(&row.by_theta, GA, BtA));
                }
                if let Some(Filled { X, .. }) = by_rates {
                    add_column(X, n, ij, path.forces(row, of_rates));
                    add_row(X, ji, Row::products(&row.by_rates, GA, BtA));
                }
                if let Some(M) = M {
                    let entries = path.forces(row, GA);
                    add_column(M, n, ij, entries);
                    add_row(M, ji, entries);
                }
                carried = path.about(row.p, carried);
                (above, way) = (run.first, model.to_base::<S>(run.parent));
                continue;
            }
            above = k;
            let (ij, ji) = (below.j * n + j, j * n + below.j);
            if let Some(Filled { X, .. }) = by_theta {
                X[ij] += path.force(k, &below, of_theta);
                X[ji] += path.by_theta(k, GA, BtA);
            }
            if let Some(Filled { X, .. }) = by_rates {
                X[ij] += path.force(k, &below, of_rates);
                X[ji] += path.by_rates(k, GA, BtA);
            }
            if let Some(M) = M {
                let entry = path.force(k, &below, GA);
                M[ij] += entry;
                M[ji] += entry;
            }
        }
        if model.is_floating() {
            carried = path.carried(above, carried);
            let Load { GA, BtA, of_theta, of_rates } = path.load(carried);
            if let Some(Filled { X, base }) = by_theta {
                add_cross(X, n, j, of_theta, base.dot(GA, BtA));
            }
            if let Some(Filled { X, base }) = by_rates {
                add_cross(X, n, j, of_rates, base.dot(GA, BtA));
            }
            if let Some(M) = M {
                add_cross(M, n, j, GA, GA);
            }
        }
        if !does.is_composite && (link.parent > 0 || model.is_floating()) {
            let (p, Ad) = (link.parent, T[i].Ad());
            G_c[p] = G_i.congruence_add(Ad, G_c[p]);
            if does.adds_factors {
                B[p] += B_i.congruence(Ad);
            }
            if does.adds_wrenches {
                F[p] = Ad.transpose().mul_add(F[i], F[p]);
            }
        }
    }
}

/// Adds the motion of a joint's own link to r of the joint's axes: `[ad_𝒱]` A, 𝒱 seen from each axis. i is the last
/// axis.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn add_moved_by_link<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, i: usize, T: &[SE3<S>], V: Twist<S>, pairs: &mut [ByRates<S>],
) {
    let (mut k, mut V) = (i, V);
    loop {
        let link = model.link::<S>(k);
        pairs[k].r += (V.ad() * link.A()).rate();
        if !link.is_next() {
            break;
        }
        (k, V) = (link.parent, T[k].inverse().Ad() * V);
    }
}

/// Cancels the term W = `[ad_A]`ᵀ𝓕ᶜ between axis i and the earlier axes of the same joint: they move together, so the
/// wrench at axis i does not move past them.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn carried_together<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, i: usize, T: &[SE3<S>], W: Wrench<S>, d_theta: &mut [S],
) {
    let (n, j, mut above, mut W) = (model.n(), model.links[i - 1].j, i, W);
    for (k, below) in model.to_base::<S>(model.links[i - 1].parent) {
        W = T[above].Ad().transpose() * W;
        d_theta[below.j * n + j] += below.A() * W;
        if !below.is_next() {
            break;
        }
        above = k;
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
#[track_caller]
pub(super) fn check_size<S: Scalar, C: Scalar>(model: &Model<C>, X: &[S]) {
    let n = model.n();
    assert!(X.len() == n * n, "a matrix has {} entries, expected n² = {}", X.len(), n * n);
}

/// Adds column j and row j at a floating base's six rows and columns.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_cross<S: Scalar>(X: &mut [S], n: usize, j: usize, column: Wrench<S>, row: Wrench<S>) {
    for (r, (column, row)) in column.to_array().into_iter().zip(row.to_array()).enumerate() {
        X[r * n + j] += column;
        X[j * n + r] += row;
    }
}

/// Adds entries of a column, from `at` on.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_column<const W: usize, S: Scalar>(X: &mut [S], n: usize, at: usize, entries: [S; W]) {
    for w in 0..W {
        X[at + w * n] += entries[w];
    }
}

/// Adds entries of a row, from `at` on.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_row<const W: usize, S: Scalar>(X: &mut [S], at: usize, entries: [S; W]) {
    let X = &mut X[at..at + W];
    for w in 0..W {
        X[w] += entries[w];
    }
}

/// Sets a column of a floating base's 6 × 6 block.
#[cfg_attr(not(debug_assertions), inline(always))]
fn set_column<S: Scalar>(X: &mut [S], n: usize, r: usize, column: Wrench<S>) {
    for (s, entry) in column.to_array().into_iter().enumerate() {
        X[s * n + r] = entry;
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{chain, tree};

    #[test]
    fn a_long_chain_is_deep_and_a_tree_of_as_many_links_is_not() {
        let tree = tree(70, 20, 0);
        assert!(chain(&tree).structure.is_deep && !tree.structure.is_deep);
    }
}
