//! M = LᵀDL along the tree's sparsity: no pivoting, no square root (Featherstone 2008, section 6.5).

use crate::scalar::Scalar;
use alloc::collections::BTreeSet;
use alloc::vec;
use alloc::vec::Vec;

/// The elimination tree: row k of L is nonzero only in the columns of k's ancestors.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// `usize::MAX` for a root.
    parent: Vec<usize>,
    /// One beyond the last descendant of k, or beyond k.
    end: Vec<usize>,
}

impl Pattern {
    /// From the number of the base's own rows, which couple with all, and from each moving link's parent slot and row, base to tips. In a plain tree the ancestors are the tree's;
    /// a follower couples its master's row with another path, and eliminating that row couples both paths.
    pub fn new(base: usize, n: usize, links: impl ExactSizeIterator<Item = (usize, usize)>) -> Self {
        let coupled = n < base + links.len();
        let links: Vec<(usize, usize)> = links.collect();
        let mut parent = vec![usize::MAX; n];
        for j in 1..base {
            parent[j] = j - 1;
        }
        if !coupled {
            for &(carrier, j) in &links {
                match carrier {
                    0 if base == 0 => {}
                    0 => parent[j] = base - 1,
                    _ => parent[j] = links[carrier - 1].1,
                }
            }
            return Pattern::of(parent);
        }
        let mut rows: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
        for &(carrier, j) in &links {
            rows[j].extend(0..base);
            let mut slot = carrier;
            while slot > 0 {
                let (next, k) = links[slot - 1];
                if k != j {
                    rows[j.max(k)].insert(j.min(k));
                }
                slot = next;
            }
        }
        for k in (base..n).rev() {
            if let Some(last) = rows[k].pop_last() {
                parent[k] = last;
                let rest = core::mem::take(&mut rows[k]);
                rows[last].extend(rest);
            }
        }
        Pattern::of(parent)
    }

    /// With each one's parent before it.
    fn of(parent: Vec<usize>) -> Self {
        let mut end: Vec<usize> = (1..=parent.len()).collect();
        for (k, &i) in parent.iter().enumerate().rev().filter(|&(_, &i)| i != usize::MAX) {
            end[i] = end[i].max(end[k]);
        }
        Pattern { parent, end }
    }

    /// Does k follow its parent?
    #[inline(always)]
    fn is_next(&self, k: usize) -> bool {
        self.parent.get(k).is_some_and(|i| i.wrapping_add(1) == k && k > 0)
    }

    /// n.
    #[inline(always)]
    fn len(&self) -> usize {
        self.parent.len()
    }

    /// k's ancestors, nearest (largest) first. A row of n numbers can be indexed by them without a further look at its length.
    #[inline(always)]
    pub fn ancestors(&self, k: usize) -> impl Iterator<Item = usize> {
        let mut i = self.parent[k];
        core::iter::from_fn(move || {
            let &next = self.parent.get(i)?;
            Some(core::mem::replace(&mut i, next))
        })
    }
}

/// Overwrites the lower triangle of M (row-major, n × n) with L (unit diagonal, not stored) and D on the diagonal.
/// The caller checks that the pivots D are positive.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn factor<S: Scalar>(pattern: &Pattern, M: &mut [S]) {
    let n = pattern.len();
    for k in (0..n).rev() {
        let (above, row) = M.split_at_mut(k * n);
        let row = &mut row[..n];
        let one_over = S::one() / row[k];
        for i in pattern.ancestors(k) {
            let (above, a) = (&mut above[i * n..][..n], row[i] * one_over);
            above[i] = row[i].mul_add(-a, above[i]);
            for j in pattern.ancestors(i) {
                above[j] = row[j].mul_add(-a, above[j]);
            }
            row[i] = a;
        }
    }
}

/// Overwrites b with x, where LᵀDLx = b.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve<S: Scalar>(pattern: &Pattern, L: &[S], b: &mut [S]) {
    let n = pattern.len();
    let b = &mut b[..n];
    for k in (0..n).rev() {
        let (L, b_k) = (&L[k * n..][..n], b[k]);
        for i in pattern.ancestors(k) {
            b[i] = L[i].mul_add(-b_k, b[i]);
        }
    }
    for k in 0..n {
        let L = &L[k * n..][..n];
        let mut b_k = b[k] / L[k];
        for i in pattern.ancestors(k) {
            b_k = L[i].mul_add(-b[i], b_k);
        }
        b[k] = b_k;
    }
}

/// Overwrites two right sides, n × n by rows, with −M⁻¹B, where M = LᵀDL; entries of B are 0 unless row and column are relatives.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve_rows<S: Scalar>(pattern: &Pattern, L: &[S], [X, Y]: [&mut [S]; 2]) {
    let n = pattern.len();
    let mut B = [&mut X[..n * n], &mut Y[..n * n]];
    for c in (0..n).step_by(8) {
        match n - c {
            1 => solve_columns::<1, S>(pattern, L, c, &mut B),
            2 => solve_columns::<2, S>(pattern, L, c, &mut B),
            3 => solve_columns::<3, S>(pattern, L, c, &mut B),
            4 => solve_columns::<4, S>(pattern, L, c, &mut B),
            5 => solve_columns::<5, S>(pattern, L, c, &mut B),
            6 => solve_columns::<6, S>(pattern, L, c, &mut B),
            7 => solve_columns::<7, S>(pattern, L, c, &mut B),
            _ => solve_columns::<8, S>(pattern, L, c, &mut B),
        }
    }
}

/// Every step of [`solve`], up to the sign, on W columns of each from c on: a step waits for the one before it, so that several columns
/// take no longer than one. Two rows on a path have the same ancestors: they go together.
#[cfg_attr(not(test), inline(always))]
fn solve_columns<const W: usize, S: Scalar>(pattern: &Pattern, L: &[S], c: usize, B: &mut [&mut [S]; 2]) {
    let mut k = pattern.end[c..c + W].iter().fold(0, |end, &e| end.max(e));
    while k > 0 {
        k -= 1;
        if k < c && pattern.end[k] <= c {
            continue; // no relative of these columns
        }
        if pattern.is_next(k) {
            k -= 1;
            eliminate::<2, W, S>(pattern, L, c, k, B);
        } else {
            eliminate::<1, W, S>(pattern, L, c, k, B);
        }
    }
    while k < pattern.len() {
        if pattern.is_next(k + 1) {
            substitute::<2, W, S>(pattern, L, c, k, B);
            k += 2;
        } else {
            substitute::<1, W, S>(pattern, L, c, k, B);
            k += 1;
        }
    }
}

/// X of LᵀX = B by rows k to k + R, a path: they leave their ancestors' rows.
#[cfg_attr(not(test), inline(always))]
fn eliminate<const R: usize, const W: usize, S: Scalar>(
    pattern: &Pattern,
    L: &[S],
    c: usize,
    k: usize,
    [X, Y]: &mut [&mut [S]; 2],
) {
    let n = pattern.len();
    let L: [&[S]; R] = core::array::from_fn(|r| &L[(k + r) * n..][..n]);
    let (X, Y) = (&mut X[..n * n], &mut Y[..n * n]);
    let [mut x, mut y] = [[[S::zero(); W]; R]; 2];
    for r in (0..R).rev() {
        let at = (k + r) * n + c;
        (x[r], y[r]) = (row(X, at), row(Y, at));
        for q in r + 1..R {
            let a = -L[q][k + r];
            (x[r], y[r]) = (add(x[r], a, x[q]), add(y[r], a, y[q]));
        }
        set_row(X, at, x[r]);
        set_row(Y, at, y[r]);
    }
    for i in pattern.ancestors(k) {
        let at = i * n + c;
        let (mut above_x, mut above_y) = (row(X, at), row(Y, at));
        for r in 0..R {
            let a = -L[r][i];
            (above_x, above_y) = (add(above_x, a, x[r]), add(above_y, a, y[r]));
        }
        set_row(X, at, above_x);
        set_row(Y, at, above_y);
    }
}

/// X of DLX = −B by rows k to k + R, a path.
#[cfg_attr(not(test), inline(always))]
fn substitute<const R: usize, const W: usize, S: Scalar>(
    pattern: &Pattern,
    L: &[S],
    c: usize,
    k: usize,
    [X, Y]: &mut [&mut [S]; 2],
) {
    let n = pattern.len();
    let L: [&[S]; R] = core::array::from_fn(|r| &L[(k + r) * n..][..n]);
    let (X, Y) = (&mut X[..n * n], &mut Y[..n * n]);
    let [mut x, mut y] = [[[S::zero(); W]; R]; 2];
    for r in 0..R {
        let (at, minus_one_over) = ((k + r) * n + c, -(S::one() / L[r][k + r]));
        let zero = [S::zero(); W];
        (x[r], y[r]) = (add(zero, minus_one_over, row(X, at)), add(zero, minus_one_over, row(Y, at)));
    }
    for i in pattern.ancestors(k) {
        let at = i * n + c;
        let (above_x, above_y) = (row(X, at), row(Y, at));
        for r in 0..R {
            let a = -L[r][i];
            (x[r], y[r]) = (add(x[r], a, above_x), add(y[r], a, above_y));
        }
    }
    for r in 0..R {
        for q in 0..r {
            let a = -L[r][k + q];
            (x[r], y[r]) = (add(x[r], a, x[q]), add(y[r], a, y[q]));
        }
        set_row(X, (k + r) * n + c, x[r]);
        set_row(Y, (k + r) * n + c, y[r]);
    }
}

/// W numbers from `at` on.
#[inline(always)]
fn row<const W: usize, S: Scalar>(B: &[S], at: usize) -> [S; W] {
    let mut row = [S::zero(); W];
    row.copy_from_slice(&B[at..at + W]);
    row
}

#[inline(always)]
fn set_row<const W: usize, S: Scalar>(B: &mut [S], at: usize, row: [S; W]) {
    B[at..at + W].copy_from_slice(&row);
}

/// y + a x.
#[inline(always)]
fn add<const W: usize, S: Scalar>(mut y: [S; W], a: S, x: [S; W]) -> [S; W] {
    for w in 0..W {
        y[w] = x[w].mul_add(a, y[w]);
    }
    y
}

/// Overwrites L and D with M⁻¹, both triangles; above the diagonal may stand any number. In LM⁻¹ = D⁻¹L⁻ᵀ the right side is upper
/// triangular: row k of M⁻¹ follows from the rows before it. `memory` is for n numbers.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn invert<S: Scalar>(pattern: &Pattern, L: &mut [S], memory: &mut [S]) {
    match pattern.len() {
        0..4 => invert_by::<1, S>(pattern, L, memory),
        4..8 => invert_by::<4, S>(pattern, L, memory),
        8..16 => invert_by::<8, S>(pattern, L, memory),
        _ => invert_by::<16, S>(pattern, L, memory),
    }
}

/// By W columns at a time, W ≤ n; the last of them overlap with others.
#[cfg_attr(not(test), inline(always))]
fn invert_by<const W: usize, S: Scalar>(pattern: &Pattern, M: &mut [S], L: &mut [S]) {
    let n = pattern.len();
    let (M, L) = (&mut M[..n * n], &mut L[..n]);
    for k in 0..n {
        let (above, row_k) = M.split_at_mut(k * n);
        let row_k = &mut row_k[..n];
        L.copy_from_slice(row_k);
        for c in (0..k).step_by(W) {
            let c = c.min(n - W);
            let mut x = [S::zero(); W];
            for i in pattern.ancestors(k) {
                x = add(x, -L[i], row(above, i * n + c));
            }
            set_row(row_k, c, x);
        }
        let mut diagonal = S::one() / L[k];
        for i in pattern.ancestors(k) {
            diagonal = row_k[i].mul_add(-L[i], diagonal);
        }
        row_k[k] = diagonal;
        for i in 0..k {
            above[i * n + k] = row_k[i];
        }
    }
}

/// x with Ax = b for a symmetric positive definite A, 6 × 6, of which the lower triangle is read; and the pivots, of the last row
/// first eliminated, for the caller to check.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve_6<S: Scalar>(mut A: [[S; 6]; 6], mut x: [S; 6]) -> ([S; 6], [S; 6]) {
    let mut pivots = [S::zero(); 6];
    for k in (0..6).rev() {
        pivots[k] = A[k][k];
        let one_over = S::one() / pivots[k];
        for i in (0..k).rev() {
            let a = A[k][i] * one_over;
            for j in 0..=i {
                A[i][j] = A[k][j].mul_add(-a, A[i][j]);
            }
            x[i] = x[k].mul_add(-a, x[i]);
            A[k][i] = a;
        }
        x[k] = x[k] * one_over;
    }
    for k in 0..6 {
        for i in 0..k {
            x[k] = A[k][i].mul_add(-x[i], x[k]);
        }
    }
    (x, pivots)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    #[test]
    fn a_follower_couples_two_paths() {
        // slots 1 → 2 → 3 and 1 → 4; slot 4 follows joint 2 (of slot 3): joints 0, 1, 2, 2
        let pattern = Pattern::new(0, 3, [(0, 0), (1, 1), (2, 2), (1, 2)].into_iter());
        assert_eq!(pattern.ancestors(2).collect::<Vec<_>>(), [1, 0]);
        // two arms whose last joints are one: joints 0, 1 and 2, 1
        let pattern = Pattern::new(0, 3, [(0, 0), (1, 1), (0, 2), (3, 1)].into_iter());
        assert_eq!(pattern.parent, [usize::MAX, 0, 1], "joint 2 couples with 1, and 1 with 0");
    }

    #[test]
    fn a_six_by_six_system() {
        let mut random = Random(6);
        let B: [[f64; 6]; 6] = core::array::from_fn(|_| random.array());
        let entry = |i: usize, j: usize| (0..6).map(|k| B[i][k] * B[j][k]).sum::<f64>() + f64::from(u8::from(i == j));
        let A: [[f64; 6]; 6] = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
        let x: [f64; 6] = random.array();
        let b = core::array::from_fn(|i| (0..6).map(|j| A[i][j] * x[j]).sum());
        let (found, pivots) = solve_6(A, b);
        assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?} {x:?}");
        let pattern = Pattern::new(6, 6, core::iter::empty::<(usize, usize)>());
        let mut M = A.as_flattened().to_vec();
        factor(&pattern, &mut M);
        assert!((0..6).all(|k| (pivots[k] - M[7 * k]).abs() < 1e-14 * pivots[k]));
    }

    #[test]
    fn factor_and_solve_a_tree_shaped_matrix() {
        // a trunk 0 with two branches 1 → 2 and 3 → 4
        let pattern = Pattern::new(0, 5, [(0, 0), (1, 1), (2, 2), (1, 3), (4, 4)].into_iter());
        let (n, mut random) = (5, Random(4));
        let mut M = vec![0.0; n * n];
        for k in 0..n {
            M[k * n + k] = 3.0 + random.next();
            for i in pattern.ancestors(k) {
                M[k * n + i] = random.next();
                M[i * n + k] = M[k * n + i];
            }
        }
        let x = random.vector(n, 1.0);
        let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| M[i * n + j] * x[j]).sum()).collect();
        let (mut rows, right) = (M.clone(), b.clone());
        factor(&pattern, &mut M);
        solve(&pattern, &M, &mut b);
        let mut twice = rows.clone();
        solve_rows(&pattern, &M, [&mut rows, &mut twice]);
        assert_eq!(rows, twice);
        let minus_one = |k: usize| if k.is_multiple_of(n + 1) { -1.0 } else { 0.0 };
        assert!(rows.iter().enumerate().all(|(k, x)| (x - minus_one(k)).abs() < 1e-14), "−M⁻¹M {rows:?}");
        assert!(b.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
        invert(&pattern, &mut M, &mut vec![f64::NAN; n]);
        let found = (0..n).map(|i| (0..n).map(|j| M[i * n + j] * right[j]).sum::<f64>());
        assert!(found.zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
    }
}
