//! M = LᵀDL along the tree's sparsity: no pivoting, no square root (Featherstone 2008, section 6.5).

pub use super::pattern::Pattern;
use crate::scalar::Scalar;

/// Overwrites the lower triangle of M (row-major, n × n) with L (unit diagonal, not stored) and D on the diagonal.
/// `pivots` receives D too: the caller checks that they are positive.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn factor<S: Scalar>(pattern: &Pattern, M: &mut [S], pivots: &mut [S]) {
    let n = pattern.len();
    for k in (0..n).rev() {
        let (above, row) = M.split_at_mut(k * n);
        let row = &mut row[..n];
        pivots[k] = row[k];
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
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn solve<S: Scalar>(pattern: &Pattern, L: &[S], b: &mut [S]) {
    solve_transposed_all(pattern, L, b);
    solve_rest(pattern, L, b);
}

/// Overwrites b with y, where Lᵀy = b.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn solve_transposed_all<S: Scalar>(pattern: &Pattern, L: &[S], b: &mut [S]) {
    solve_transposed(pattern, L, b, (0..pattern.len()).rev());
}

/// Overwrites b with y, where Lᵀy = b and b is zero outside `rows`. Rows are in descending order, each with its
/// ancestors.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn solve_transposed<S: Scalar>(pattern: &Pattern, L: &[S], b: &mut [S], rows: impl Iterator<Item = usize>) {
    let n = pattern.len();
    let b = &mut b[..n];
    for k in rows {
        let (L, b_k) = (&L[k * n..][..n], b[k]);
        for i in pattern.ancestors(k) {
            b[i] = L[i].mul_add(-b_k, b[i]);
        }
    }
}

/// Overwrites y with x, where DLx = y.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn solve_rest<S: Scalar>(pattern: &Pattern, L: &[S], b: &mut [S]) {
    let n = pattern.len();
    let b = &mut b[..n];
    for k in 0..n {
        let L = &L[k * n..][..n];
        let mut b_k = b[k] / L[k];
        for i in pattern.ancestors(k) {
            b_k = L[i].mul_add(-b[i], b_k);
        }
        b[k] = b_k;
    }
}

/// Overwrites two right-hand sides, n × n by rows, with −M⁻¹B, where M = LᵀDL; entries of B are 0 unless row and column
/// are equal or one is an ancestor of the other.
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// Every step of [`solve`], up to the sign, on W columns of each matrix, from c on. The steps of one column depend on
/// each other, so several columns take no longer than one. Two consecutive rows of a path have the same ancestors and
/// are processed together.
#[cfg_attr(not(debug_assertions), inline(always))]
fn solve_columns<const W: usize, S: Scalar>(pattern: &Pattern, L: &[S], c: usize, B: &mut [&mut [S]; 2]) {
    let mut k = pattern.end[c..c + W].iter().fold(0, |end, &e| end.max(e));
    while k > 0 {
        k -= 1;
        if k < c && pattern.end[k] <= c {
            continue; // neither an ancestor nor a descendant of these columns
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

/// X of LᵀX = B for rows k to k + R, a path: subtracts their contribution from their ancestors' rows.
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// X of DLX = −B for rows k to k + R, a path.
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// Overwrites L and D with M⁻¹, both triangles; entries above the diagonal are ignored on input. In LM⁻¹ = D⁻¹L⁻ᵀ the
/// right side is upper triangular: row k of M⁻¹ follows from the rows before it. `memory` is for n numbers.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn invert<S: Scalar>(pattern: &Pattern, L: &mut [S], memory: &mut [S]) {
    match pattern.len() {
        0..4 => invert_by::<1, S>(pattern, L, memory),
        4..8 => invert_by::<4, S>(pattern, L, memory),
        8..16 => invert_by::<8, S>(pattern, L, memory),
        _ => invert_by::<16, S>(pattern, L, memory),
    }
}

/// W columns at a time, W ≤ n; the last block may overlap others.
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// x with Ax = b for a symmetric positive definite A, 6 × 6, of which the lower triangle is read; and the pivots for
/// the caller to check. The last row is eliminated first.
#[cfg_attr(not(debug_assertions), inline(always))]
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
    use alloc::vec;
    use alloc::vec::Vec;

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
        factor(&pattern, &mut M, &mut vec![0.0; pattern.len()]);
        assert!((0..6).all(|k| (pivots[k] - M[7 * k]).abs() < 1e-14 * pivots[k]));
    }

    /// After the base's rows, limbs: each is given by its carrier slot (0: the base) and its number of joints.
    fn limbs(base: usize, limbs: &[(usize, usize)]) -> Pattern {
        let mut links = Vec::new();
        for &(mut carrier, joints) in limbs {
            for _ in 0..joints {
                links.push((carrier, base + links.len()));
                carrier = links.len();
            }
        }
        Pattern::new(base, base + links.len(), links.into_iter())
    }

    #[test]
    fn factor_and_solve_tree_shaped_matrices() {
        let trunk_and_branches: [(usize, &[(usize, usize)]); 6] = [
            (0, &[(0, 1)]),
            (0, &[(0, 3)]),
            (0, &[(0, 1), (1, 2), (1, 2)]),
            (0, &[(0, 4), (0, 7)]),
            (6, &[(0, 3), (0, 3), (0, 1)]),
            (6, &[(0, 6), (0, 6), (0, 2), (14, 8), (14, 8), (14, 2)]),
        ];
        for (base, branches) in trunk_and_branches {
            solve_a_random_system(&limbs(base, branches));
        }
        // two arms on joint 1, the last joint of the second mimics joint 8 of the first
        let arms: Vec<_> = (0..9).map(|j| (j, j)).chain([(2, 9), (10, 10), (11, 8)]).collect();
        solve_a_random_system(&Pattern::new(0, 11, arms.into_iter()));
    }

    /// M and B are random where the pattern has entries.
    fn solve_a_random_system(pattern: &Pattern) {
        let (n, mut random) = (pattern.len(), Random(4));
        let mut M = vec![0.0; n * n];
        let mut B = M.clone();
        for k in 0..n {
            M[k * n + k] = n as f64 + 2.0 + random.next();
            B[k * n + k] = random.next();
            for i in pattern.ancestors(k) {
                M[k * n + i] = random.next();
                M[i * n + k] = M[k * n + i];
                (B[k * n + i], B[i * n + k]) = (random.next(), random.next());
            }
        }
        let x = random.vector(n, 1.0);
        let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| M[i * n + j] * x[j]).sum()).collect();
        let (mut rows, mut more, right) = (M.clone(), B.clone(), b.clone());
        factor(pattern, &mut M, &mut vec![0.0; pattern.len()]);
        solve(pattern, &M, &mut b);
        assert!(b.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
        solve_rows(pattern, &M, [&mut rows, &mut more]);
        let minus_one = |k: usize| if k.is_multiple_of(n + 1) { -1.0 } else { 0.0 };
        assert!(rows.iter().enumerate().all(|(k, x)| (x - minus_one(k)).abs() < 1e-14), "−M⁻¹M {rows:?}");
        for j in 0..n {
            let mut column: Vec<f64> = (0..n).map(|i| B[i * n + j]).collect();
            solve(pattern, &M, &mut column);
            assert!((0..n).all(|i| (column[i] + more[i * n + j]).abs() < 1e-14), "column {j} of −M⁻¹B");
        }
        invert(pattern, &mut M, &mut vec![f64::NAN; n]);
        let found = (0..n).map(|i| (0..n).map(|j| M[i * n + j] * right[j]).sum::<f64>());
        assert!(found.zip(&x).all(|(a, b)| (a - b).abs() < 1e-13));
        assert!((0..n * n).all(|k| M[k] == M[k % n * n + k / n]), "symmetric");
    }
}
