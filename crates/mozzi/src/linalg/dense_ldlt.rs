//! G = LDLᵀ of a full symmetric matrix: no pivoting, no square root. Each step changes numbers that do not depend on
//! each other.

use crate::scalar::Scalar;

/// Overwrites the lower triangle of G (row-major, m × m) with L (unit diagonal, not stored), and fills `one_over_d`
/// with 1/D.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn factor<S: Scalar>(G: &mut [S], one_over_d: &mut [S]) {
    let m = one_over_d.len();
    for k in 0..m {
        let inverse = S::one() / G[k * m + k];
        one_over_d[k] = inverse;
        for i in (k + 1..m).rev() {
            // rows above i still have column k as it was
            let a = G[i * m + k] * inverse;
            for j in k + 1..=i {
                G[i * m + j] = G[j * m + k].mul_add(-a, G[i * m + j]);
            }
            G[i * m + k] = a;
        }
    }
}

/// Overwrites b with x, where LDLᵀx = b.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve<S: Scalar>(L: &[S], one_over_d: &[S], b: &mut [S]) {
    let m = one_over_d.len();
    for k in 0..m {
        let x = -b[k];
        for i in k + 1..m {
            b[i] = L[i * m + k].mul_add(x, b[i]);
        }
    }
    for k in 0..m {
        b[k] = b[k] * one_over_d[k];
    }
    for k in (0..m).rev() {
        let (row, x) = (&L[k * m..][..k], -b[k]);
        for (b, &l) in b[..k].iter_mut().zip(row) {
            *b = l.mul_add(x, *b);
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
