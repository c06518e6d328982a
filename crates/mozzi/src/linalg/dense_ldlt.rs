//! G = LDLᵀ of a full symmetric matrix: no pivoting, no square root. Each step changes numbers that do not depend on
//! each other.

use crate::scalar::Scalar;

/// Overwrites the upper triangle of G (row-major, m × m) with Lᵀ (unit diagonal, not stored), and fills `one_over_d`
/// with 1/D.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn factor<S: Scalar>(G: &mut [S], one_over_d: &mut [S]) {
    let m = one_over_d.len();
    for k in 0..m {
        let (row_k, below) = G[k * m..m * m].split_at_mut(m);
        let inverse = S::one() / row_k[k];
        one_over_d[k] = inverse;
        for i in k + 1..m {
            let (row_i, row_k) = (&mut below[(i - k - 1) * m..][..m][i..], &mut row_k[i..]);
            let a = row_k[0] * inverse;
            for (x, &y) in row_i.iter_mut().zip(&*row_k) {
                *x = y.mul_add(-a, *x);
            }
            row_k[0] = a;
        }
    }
}

/// Overwrites b with x, where LDLᵀx = b.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn solve<S: Scalar>(Lt: &[S], one_over_d: &[S], b: &mut [S]) {
    let m = one_over_d.len();
    let b = &mut b[..m];
    for k in 0..m {
        let (x, row) = (-b[k], &Lt[k * m..][..m]);
        for (b, &l) in b[k + 1..].iter_mut().zip(&row[k + 1..]) {
            *b = l.mul_add(x, *b);
        }
    }
    for k in 0..m {
        b[k] = b[k] * one_over_d[k];
    }
    for k in (0..m).rev() {
        let (before, x) = b.split_at_mut(k);
        let x = -x[0];
        for (b, row) in before.iter_mut().zip(Lt.chunks_exact(m)) {
            *b = row[k].mul_add(x, *b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    #[test]
    fn a_matrix_times_what_it_gives_is_the_right_side() {
        let (m, mut random) = (7, Random(3));
        let B = random.vector(m * m, 1.0);
        let at = |i: usize, j: usize| (0..m).map(|k| B[i * m + k] * B[j * m + k]).sum::<f64>();
        let G: Vec<f64> = (0..m * m).map(|k| at(k / m, k % m)).collect();
        let b = random.vector(m, 1.0);
        let (mut L, mut one_over_d, mut x) = (G.clone(), vec![0.0; m], b.clone());
        factor(&mut L, &mut one_over_d);
        solve(&L, &one_over_d, &mut x);
        for i in 0..m {
            let sum: f64 = (0..m).map(|j| G[i * m + j] * x[j]).sum();
            assert!((sum - b[i]).abs() < 1e-10, "{sum} {}", b[i]);
        }
    }
}
