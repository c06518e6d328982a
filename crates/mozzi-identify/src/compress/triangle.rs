//! Equations added to a triangle: a QR decomposition that grows by rows (Golub and Van Loan, section 12.5.1; blocked as
//! by Schreiber and Van Loan 1989).

use nalgebra::{DMatrix, DMatrixViewMut, DVector};

/// Columns that are eliminated before the others are updated by matrix products.
const PANEL: usize = 24;

/// The triangle R of QR = [A b]: ‖A x − b‖ = ‖R₁ x − z‖ + a constant, for every x.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// Upper triangular, (P + 1) × (P + 1): R₁, z and the length of what no x can reach.
    pub R: DMatrix<f64>,
    /// The number of equations in it.
    pub rows: usize,
    /// Σ of the squared forces.
    pub square: f64,
}

impl Triangle {
    /// No equations in P unknowns.
    pub fn new(P: usize) -> Self {
        Triangle { R: DMatrix::zeros(P + 1, P + 1), rows: 0, square: 0.0 }
    }

    /// Adds equations: a matrix of rows (A b), which is overwritten. `rows` of them count as equations.
    ///
    /// # Panics
    /// When the matrix has not P + 1 columns.
    pub fn push(&mut self, B: DMatrix<f64>, rows: usize) {
        let height = B.nrows();
        self.add(B, rows, |_| height);
    }

    /// Adds equations in a form in which column k has entries in its first k + 1 rows alone, as a triangle: at a third
    /// of the cost.
    ///
    /// # Panics
    /// When the matrix has not P + 1 columns.
    pub fn push_upper(&mut self, B: DMatrix<f64>, rows: usize) {
        let height = B.nrows();
        self.add(B, rows, |column| height.min(column + 1));
    }

    fn add(&mut self, mut B: DMatrix<f64>, rows: usize, height: impl Fn(usize) -> usize) {
        let size = self.R.ncols();
        assert!(B.ncols() == size, "{} columns, expected {size}", B.ncols());
        self.rows += rows;
        for first in (0..size).step_by(PANEL) {
            let count = PANEL.min(size - first);
            let filled = height(first + count - 1);
            let mut B = B.rows_mut(0, filled);
            let T = self.panel(&mut B, first, count);
            let rest = size - first - count;
            if rest == 0 {
                continue;
            }
            // Qᵀ [R; B] of the columns to the right, Q = 1 − [1; V] T [1; V]ᵀ
            let (V, mut right) = B.columns_range_pair_mut(first..first + count, first + count..size);
            let mut top = self.R.view_mut((first, first + count), (count, rest));
            let mut W = top.clone_owned();
            W.gemm(1.0, &V.transpose(), &right, 1.0); // not gemm_tr, which is a loop over columns
            let W = T.transpose() * W;
            top -= &W;
            right.gemm(-1.0, &V, &W, 1.0);
        }
    }

    /// Eliminates a few columns of B by reflections; B keeps their vectors. Returns T of the compact form.
    fn panel(&mut self, B: &mut DMatrixViewMut<f64>, first: usize, count: usize) -> DMatrix<f64> {
        let mut T = DMatrix::zeros(count, count);
        for k in 0..count {
            let c = first + k;
            let (alpha, below) = (self.R[(c, c)], B.column(c).norm_squared());
            if below == 0.0 {
                continue; // this reflection is the identity
            }
            let length = (alpha * alpha + below).sqrt();
            let beta = if alpha > 0.0 { -length } else { length };
            let tau = (beta - alpha) / beta;
            B.column_mut(c).scale_mut(1.0 / (alpha - beta));
            self.R[(c, c)] = beta;
            for l in k + 1..count {
                let (v, mut x) = B.columns_range_pair_mut(c, first + l);
                let w = tau * (self.R[(c, first + l)] + v.dot(&x));
                self.R[(c, first + l)] -= w;
                x.axpy(-w, &v, 1.0);
            }
            // T's next column: −τ T Vᵀv; the unit parts of different reflections are orthogonal
            let products = DVector::from_fn(k, |i, _| B.column(first + i).dot(&B.column(c)));
            let column = T.view((0, 0), (k, k)) * products * (-tau);
            T.view_mut((0, k), (k, 1)).copy_from(&column);
            T[(k, k)] = tau;
        }
        T
    }

    /// Adds the equations of another triangle, all of them times a factor.
    pub fn merge(&mut self, other: &Triangle, factor: f64) {
        self.push_upper(&other.R * factor, other.rows);
        self.square += factor * factor * other.square;
    }

    /// The number of unknowns P.
    pub fn unknowns(&self) -> usize {
        self.R.ncols() - 1
    }

    /// ‖A x − b‖².
    pub fn error(&self, x: &[f64]) -> f64 {
        let P = self.unknowns();
        let mut sum = self.R[(P, P)].powi(2);
        for row in 0..P {
            let mut e = -self.R[(row, P)];
            for column in row..P {
                e += self.R[(row, column)] * x[column];
            }
            sum += e * e;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::random::Random;

    #[test]
    fn a_triangle_that_grows_has_the_gram_matrix_of_its_equations() {
        for P in [3, 24, 25, 60] {
            let mut random = Random(P as u64);
            let all = DMatrix::from_fn(5 * P, P + 1, |_, _| random.next());
            let mut triangle = Triangle::new(P);
            for first in (0..5 * P).step_by(P) {
                triangle.push(all.rows(first, P).clone_owned(), P);
            }
            let (expected, found) = (all.transpose() * &all, triangle.R.transpose() * &triangle.R);
            assert!((expected - found).amax() < 1e-12 * (5 * P) as f64);
            assert!((0..P).all(|k| (k + 1..=P).all(|i| triangle.R[(i, k)] == 0.0)));
            let x = random.vector(P, 1.0);
            let direct = (all.columns(0, P) * DVector::from_column_slice(&x) - all.column(P)).norm_squared();
            assert!((triangle.error(&x) - direct).abs() < 1e-11 * direct);
            assert_eq!(triangle.rows, 5 * P);
            let mut two = triangle.clone();
            two.merge(&triangle, 2.0);
            let (expected, found) = (5.0 * all.transpose() * &all, two.R.transpose() * &two.R);
            assert!((expected - found).amax() < 1e-12 * (25 * P) as f64);
        }
    }
}
