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
            return Pattern { parent };
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
        Pattern { parent }
    }

    /// k's ancestors, nearest (largest) first.
    #[inline(always)]
    pub fn ancestors(&self, k: usize) -> impl Iterator<Item = usize> {
        core::iter::successors(self.parent.get(k).copied(), |&i| self.parent.get(i).copied())
            .take_while(|&i| i != usize::MAX)
    }
}

/// Overwrites the lower triangle of M (row-major, n × n) with L (unit diagonal, not stored) and D on the diagonal.
/// The caller checks that the pivots D are positive.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn factor<S: Scalar>(pattern: &Pattern, n: usize, M: &mut [S]) {
    for k in (0..n).rev() {
        let one_over = S::one() / M[k * n + k];
        for i in pattern.ancestors(k) {
            let a = M[k * n + i] * one_over;
            M[i * n + i] = M[k * n + i].mul_add(-a, M[i * n + i]);
            for j in pattern.ancestors(i) {
                M[i * n + j] = M[k * n + j].mul_add(-a, M[i * n + j]);
            }
            M[k * n + i] = a;
        }
    }
}

/// Overwrites b with x, where LᵀDLx = b.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve<S: Scalar>(pattern: &Pattern, n: usize, L: &[S], b: &mut [S]) {
    for k in (0..n).rev() {
        for i in pattern.ancestors(k) {
            let Lki_bk = L[k * n + i] * b[k];
            b[i] -= Lki_bk;
        }
    }
    for k in 0..n {
        b[k] = b[k] / L[k * n + k];
        for i in pattern.ancestors(k) {
            let Lki_xi = L[k * n + i] * b[i];
            b[k] -= Lki_xi;
        }
    }
}

/// Overwrites B, n × n by rows, with −M⁻¹B, where M = LᵀDL.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve_rows<S: Scalar>(pattern: &Pattern, n: usize, L: &[S], B: &mut [S]) {
    for c in (0..n).step_by(8) {
        let B = &mut B[c..];
        match n - c {
            1 => solve_columns::<1, S>(pattern, n, L, B),
            2 => solve_columns::<2, S>(pattern, n, L, B),
            3 => solve_columns::<3, S>(pattern, n, L, B),
            4 => solve_columns::<4, S>(pattern, n, L, B),
            5 => solve_columns::<5, S>(pattern, n, L, B),
            6 => solve_columns::<6, S>(pattern, n, L, B),
            7 => solve_columns::<7, S>(pattern, n, L, B),
            _ => solve_columns::<8, S>(pattern, n, L, B),
        }
    }
}

/// Every step of [`solve`], up to the sign, on the W columns that B begins with.
#[cfg_attr(not(test), inline(always))]
fn solve_columns<const W: usize, S: Scalar>(pattern: &Pattern, n: usize, L: &[S], B: &mut [S]) {
    let at = |B: &[S], k: usize| -> [S; W] {
        let row = &B[k * n..][..W];
        core::array::from_fn(|c| row[c])
    };
    for k in (0..n).rev() {
        let row = at(B, k);
        for i in pattern.ancestors(k) {
            let (above, a) = (at(B, i), -L[k * n + i]);
            B[i * n..][..W].copy_from_slice(&core::array::from_fn::<S, W, _>(|c| row[c].mul_add(a, above[c])));
        }
    }
    for k in 0..n {
        let minus_one_over = -(S::one() / L[k * n + k]);
        let mut row = at(B, k).map(|x| x * minus_one_over);
        for i in pattern.ancestors(k) {
            let (above, a) = (at(B, i), -L[k * n + i]);
            row = core::array::from_fn(|c| above[c].mul_add(a, row[c]));
        }
        B[k * n..][..W].copy_from_slice(&row);
    }
}

/// Overwrites L and D with M⁻¹, both triangles. In LM⁻¹ = D⁻¹L⁻ᵀ the right side is upper triangular: row k of M⁻¹ follows from the
/// rows before it. `memory` is for n numbers.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn invert<S: Scalar>(pattern: &Pattern, n: usize, L: &mut [S], memory: &mut [S]) {
    for k in 0..n {
        let row = &mut memory[..k];
        row.fill(S::zero());
        for i in pattern.ancestors(k) {
            add(row, -L[k * n + i], &L[i * n..][..k]);
        }
        let mut diagonal = S::one() / L[k * n + k];
        for i in pattern.ancestors(k) {
            diagonal = row[i].mul_add(-L[k * n + i], diagonal);
        }
        L[k * n + k] = diagonal;
        for (i, &entry) in row.iter().enumerate() {
            L[k * n + i] = entry;
            L[i * n + k] = entry;
        }
    }
}

/// y + a x.
#[cfg_attr(not(test), inline(always))]
fn add<S: Scalar>(y: &mut [S], a: S, x: &[S]) {
    for (y, &x) in y.iter_mut().zip(x) {
        *y = x.mul_add(a, *y);
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
        factor(&pattern, 6, &mut M);
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
        factor(&pattern, n, &mut M);
        solve(&pattern, n, &M, &mut b);
        solve_rows(&pattern, n, &M, &mut rows);
        let minus_one = |k: usize| if k.is_multiple_of(n + 1) { -1.0 } else { 0.0 };
        assert!(rows.iter().enumerate().all(|(k, x)| (x - minus_one(k)).abs() < 1e-14), "−M⁻¹M {rows:?}");
        assert!(b.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
        invert(&pattern, n, &mut M, &mut vec![f64::NAN; n]);
        let found = (0..n).map(|i| (0..n).map(|j| M[i * n + j] * right[j]).sum::<f64>());
        assert!(found.zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
    }
}
