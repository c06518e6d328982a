//! Linear equations in any number type: Gaussian elimination with row pivots.

use mozzi::nalgebra::DMatrix;
use mozzi::{Entry, Scalar};

/// X with AX = B; None if A is singular.
pub fn solve<S: Entry>(A: &DMatrix<S>, B: &DMatrix<S>) -> Option<DMatrix<S>> {
    let (n, mut A, mut X) = (A.nrows(), A.clone(), B.clone());
    for k in 0..n {
        let pivot = (k..n).fold(k, |best, i| if A[(i, k)].abs() > A[(best, k)].abs() { i } else { best });
        if A[(pivot, k)] == <S as Scalar>::zero() {
            return None;
        }
        A.swap_rows(k, pivot);
        X.swap_rows(k, pivot);
        for i in k + 1..n {
            let factor = A[(i, k)] / A[(k, k)];
            for j in k..n {
                let term = factor * A[(k, j)];
                A[(i, j)] -= term;
            }
            for j in 0..X.ncols() {
                let term = factor * X[(k, j)];
                X[(i, j)] -= term;
            }
        }
    }
    for j in 0..X.ncols() {
        for i in (0..n).rev() {
            let sum = (i + 1..n).fold(X[(i, j)], |sum, k| sum - A[(i, k)] * X[(k, j)]);
            X[(i, j)] = sum / A[(i, i)];
        }
    }
    Some(X)
}

/// A⁻¹; None if A is singular.
pub fn inverse<S: Entry>(A: &DMatrix<S>) -> Option<DMatrix<S>> {
    solve(A, &DMatrix::identity(A.nrows(), A.nrows()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_solves_what_needs_an_exchange_of_rows() {
        let A = DMatrix::from_row_slice(3, 3, &[0.0, 2.0, 1.0, 1.0, 1e-3, 0.0, 4.0, 0.0, -3.0]);
        let error = inverse(&A).expect("regular") * &A - DMatrix::identity(3, 3);
        assert!(error.amax() < 1e-14);
        assert_eq!(solve(&DMatrix::<f64>::zeros(2, 2), &DMatrix::zeros(2, 1)), None);
    }
}
