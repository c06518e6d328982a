//! M = LᵀDL along the tree's sparsity: no pivoting, no square root (Featherstone 2008, section 6.5).

use crate::scalar::Scalar;

/// For each row of L, the columns left of the diagonal that can be nonzero, fill-in included.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    rows: alloc::vec::Vec<alloc::vec::Vec<u32>>,
}

impl Pattern {
    /// From the nonzero columns left of the diagonal in each row of M. Eliminating row k couples all its columns.
    pub fn new(mut rows: alloc::vec::Vec<alloc::vec::Vec<u32>>) -> Self {
        for k in (0..rows.len()).rev() {
            rows[k].sort_unstable();
            rows[k].dedup();
            // within one tree path the columns are coupled already; a follower's row may couple two paths
            if let Some((&last, rest)) = rows[k].split_last() {
                let rest = rest.to_vec();
                let row = &mut rows[last as usize];
                row.extend(rest);
                row.sort_unstable();
                row.dedup();
            }
        }
        Pattern { rows }
    }

    fn row(&self, k: usize) -> impl DoubleEndedIterator<Item = usize> + Clone {
        self.rows[k].iter().map(|&i| i as usize)
    }
}

/// Overwrites the lower triangle of M (row-major, n × n) with L (unit diagonal, not stored) and D on the diagonal.
/// The caller checks that the pivots D are positive.
#[inline(always)]
pub(crate) fn factor<S: Scalar>(pattern: &Pattern, n: usize, M: &mut [S]) {
    for k in (0..n).rev() {
        let pivot = M[k * n + k];
        for i in pattern.row(k).rev() {
            let a = M[k * n + i] / pivot;
            for j in pattern.row(k).take_while(|&j| j <= i) {
                M[i * n + j] -= a * M[k * n + j];
            }
            M[k * n + i] = a;
        }
    }
}

/// Overwrites b with x, where LᵀDLx = b.
#[inline(always)]
pub(crate) fn solve<S: Scalar>(pattern: &Pattern, n: usize, L: &[S], b: &mut [S]) {
    for k in (0..n).rev() {
        for i in pattern.row(k) {
            let Lki_bk = L[k * n + i] * b[k];
            b[i] -= Lki_bk;
        }
    }
    for k in 0..n {
        b[k] = b[k] / L[k * n + k];
        for i in pattern.row(k) {
            let Lki_xi = L[k * n + i] * b[i];
            b[k] -= Lki_xi;
        }
    }
}
