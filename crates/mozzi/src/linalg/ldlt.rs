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
#[inline(always)]
pub(crate) fn factor<S: Scalar>(pattern: &Pattern, n: usize, M: &mut [S]) {
    for k in (0..n).rev() {
        let pivot = M[k * n + k];
        for i in pattern.ancestors(k) {
            let a = M[k * n + i] / pivot;
            let Mki = M[k * n + i];
            M[i * n + i] -= a * Mki;
            for j in pattern.ancestors(i) {
                let Mkj = M[k * n + j];
                M[i * n + j] -= a * Mkj;
            }
            M[k * n + i] = a;
        }
    }
}

/// Overwrites b with x, where LᵀDLx = b.
#[inline(always)]
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
        factor(&pattern, n, &mut M);
        solve(&pattern, n, &M, &mut b);
        assert!(b.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
    }
}
