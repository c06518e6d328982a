//! −M⁻¹X by articulated bodies, for robots with long limbs (Featherstone 2008, section 7.3): O(n) per column; with the
//! factors of M it would be O(n · depth).
//!
//! The factors of forward dynamics are factors of M. With Ĝ, the articulated inertia of a link (all joints beyond it
//! free),
//!
//! > d = AᵀĜA + armature, U = ĜA/d
//!
//! M x = b is solved in two passes: wrenches P go inward to the base, accelerations a go outward to the tips:
//!
//! > u = b − AᵀP, P_p += P + U u, then x = u/d − Uᵀa, with a = a_p from the parent, a += A x
//!
//! All quantities are in the base's axes, about each link's own origin, so a step to a parent is a shift.

use crate::linalg::ldlt;
use crate::model::{AtLink, Model, TOGETHER as W, Turned, Workspace};
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use alloc::vec::Vec;

/// Overwrites X and Y, n × n by rows, with −M⁻¹X and −M⁻¹Y, and `inverse` with M⁻¹. The workspace holds the factors of
/// forward dynamics, and R, p and A of the links in the base's axes.
#[cfg_attr(not(test), inline(always))]
pub(super) fn solve_columns<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &mut Workspace<S>,
    [X, Y, inverse]: [&mut [S]; 3],
) {
    let (n, N) = (model.n(), model.links.len());
    let Workspace { turned, U, G_hat, columns, pivots, .. } = workspace;
    for (now, U) in turned.iter_mut().zip(U.iter()).skip(1) {
        now.U = Wrench { m: now.R * U.m, f: now.R * U.f };
    }
    // M⁻¹ = −M⁻¹(−1), solved for the lower triangle alone: a column of −1 has one entry
    inverse.fill(S::zero());
    for j in 0..n {
        inverse[j * (n + 1)] = -S::one();
    }
    let base = if model.is_floating() { n - N } else { 0 };
    let at_base = model.is_floating().then(|| inverse_6(G_hat[0].to_matrix()));
    let factors = Factors { links: turned, pivots, at_base };
    for c in (0..n).step_by(W) {
        let outermost = (c + W).min(n).saturating_sub(base);
        let all = [(&mut *X, [0, N]), (&mut *Y, [0, N]), (&mut *inverse, [c, outermost])];
        factors.solve(model, all, columns, c);
    }
    for j in 0..n {
        for i in 0..j {
            inverse[i * n + j] = inverse[j * n + i];
        }
    }
}

struct Factors<'w, S> {
    links: &'w [Turned<S>],
    pivots: &'w [S],
    /// Ĝ⁻¹ of a floating base.
    at_base: Option<[[S; 6]; 6]>,
}

impl<S: Scalar> Factors<'_, S> {
    /// Solves W columns, from c on, of three matrices; they are interleaved because they are independent. Each matrix
    /// comes with its first nonzero row and its outermost nonzero link; rows before the first are not written.
    #[inline(always)]
    fn solve<C: Scalar>(
        &self,
        model: &Model<C>,
        mut X: [(&mut [S], [usize; 2]); 3],
        columns: &mut [Vec<AtLink<S>>; 3],
        c: usize,
    ) where
        S: From<C>,
    {
        let (n, links) = (model.n(), &model.links);
        let width = W.min(n - c);
        for ((X, [first, _]), at) in X.iter().zip(columns.iter_mut()) {
            at[0] = AtLink::zero();
            for (at, link) in at[1..].iter_mut().zip(links) {
                *at = AtLink::zero();
                if link.j >= *first {
                    at.x[..width].copy_from_slice(&X[link.j * n + c..][..width]);
                }
            }
        }
        for i in (1..=links.len()).rev() {
            for k in 0..3 {
                if i <= X[k].1[1] {
                    self.inward(i, links[i - 1].parent, &mut columns[k]);
                }
            }
        }
        for k in 0..3 {
            let (X, [first, _]) = &mut X[k];
            self.base(X, *first, n, c, &mut columns[k][0].six);
        }
        for i in 1..=links.len() {
            let (parent, one_over_d) = (links[i - 1].parent, S::one() / self.pivots[links[i - 1].j]);
            for k in 0..3 {
                self.outward(i, parent, one_over_d, &mut columns[k]);
            }
        }
        for ((X, [first, _]), at) in X.iter_mut().zip(columns.iter()) {
            for (at, link) in at[1..].iter().zip(links).filter(|(_, link)| link.j >= *first) {
                X[link.j * n + c..][..width].copy_from_slice(&at.x[..width]);
            }
        }
    }

    /// u = −b − AᵀP, and the wrench passed on to the parent, about the parent's origin: m − p × f, with p from the
    /// link's origin to the parent's.
    #[inline(always)]
    #[rustfmt::skip]
    fn inward(&self, i: usize, parent: usize, at: &mut [AtLink<S>]) {
        let link = &self.links[i];
        let (A, U) = (link.A.to_array(), link.U.to_array());
        let AtLink { x: mut u, six: mut F } = at[i];
        let mut by_force = [S::zero(); W];
        for r in 0..3 { add(&mut u, A[r], F[r]); add(&mut by_force, A[r + 3], F[r + 3]); }
        for w in 0..W { u[w] = -(u[w] + by_force[w]); }
        at[i].x = u;
        if parent == 0 && self.at_base.is_none() {
            return;
        }
        for r in 0..6 { add(&mut F[r], U[r], u); }
        let ([x, y, z], [f, g, h]) = (link.p.0, [F[3], F[4], F[5]]);
        add(&mut F[0], -y, h); add(&mut F[0], z, g);
        add(&mut F[1], -z, f); add(&mut F[1], x, h);
        add(&mut F[2], -x, g); add(&mut F[2], y, f);
        let above = &mut at[parent].six;
        for r in 0..6 {
            for w in 0..W { above[r][w] += F[r][w]; }
        }
    }

    /// Replaces the wrench at a floating base by the base's acceleration; for a fixed base it is 0.
    #[inline(always)]
    #[rustfmt::skip]
    fn base(&self, X: &mut [S], first: usize, n: usize, c: usize, P: &mut [[S; W]; 6]) {
        let (mut u, width) = (*P, W.min(n - c));
        *P = [[S::zero(); W]; 6];
        let Some(inverse) = &self.at_base else { return };
        for r in first..6 {
            for w in 0..width { u[r][w] += X[r * n + c + w]; }
        }
        for r in 0..6 {
            for k in 0..6 { add(&mut P[r], -inverse[r][k], u[k]); }
        }
        for r in first..6 {
            X[r * n + c..][..width].copy_from_slice(&P[r][..width]);
        }
    }

    /// x = u/d − Uᵀa, with the parent's a shifted to the link's origin: v + p × ω.
    #[inline(always)]
    #[rustfmt::skip]
    fn outward(&self, i: usize, parent: usize, one_over_d: S, at: &mut [AtLink<S>]) {
        let link = &self.links[i];
        let (A, U) = (link.A.to_array(), link.U.to_array());
        let (mut q, mut a) = (at[i].x, at[parent].six);
        let ([x, y, z], [f, g, h]) = (link.p.0, [a[0], a[1], a[2]]);
        add(&mut a[3], y, h); add(&mut a[3], -z, g);
        add(&mut a[4], z, f); add(&mut a[4], -x, h);
        add(&mut a[5], x, g); add(&mut a[5], -y, f);
        for w in 0..W { q[w] = q[w] * one_over_d; }
        let mut by_turn = [S::zero(); W];
        for r in 0..3 { add(&mut q, -U[r + 3], a[r + 3]); add(&mut by_turn, -U[r], a[r]); }
        for w in 0..W { q[w] += by_turn[w]; }
        for r in 0..6 { add(&mut a[r], A[r], q); }
        at[i] = AtLink { x: q, six: a };
    }
}

/// y += k x.
#[inline(always)]
fn add<S: Scalar>(y: &mut [S; W], k: S, x: [S; W]) {
    for w in 0..W {
        y[w] = x[w].mul_add(k, y[w]);
    }
}

/// A⁻¹ of a symmetric positive definite A.
#[inline(always)]
fn inverse_6<S: Scalar>(A: [[S; 6]; 6]) -> [[S; 6]; 6] {
    let mut inverse = [[S::zero(); 6]; 6];
    for r in 0..6 {
        let mut e = [S::zero(); 6];
        e[r] = S::one();
        inverse[r] = ldlt::solve_6(A, e).0;
    }
    inverse
}
