//! The alternating direction method of multipliers for cone complementarity with De Saxcé's term (Carpentier, Le Lidec
//! and Montaut 2024).

use super::Problem;
use mozzi::scalar::Scalar;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The proximal weight, relative to the largest eigenvalue.
const PROXIMAL: f64 = 1e-9;
/// A penalty is adapted after this many iterations, if the two residuals differ by more than this factor.
const EVERY: usize = 10;
const APART: f64 = 10.0;

pub(super) struct Admm {
    p: DVector<f64>,
    y: DVector<f64>,
    z: DVector<f64>,
    rho: f64,
    /// The largest eigenvalue of G.
    largest: f64,
    /// G = W Wᵀ, with orthogonal columns, and their squares λ.
    W: DMatrix<f64>,
    squares: DVector<f64>,
    iterations: usize,
    done: bool,
}

impl Admm {
    /// With R of G = RᵀR, n × m, if it is known.
    pub fn new(problem: &Problem, root: Option<&DMatrix<f64>>, guess: &DVector<f64>) -> Self {
        let (W, squares) = match root {
            Some(R) if R.nrows() < R.ncols() => {
                let SymmetricEigen { eigenvectors: Q, eigenvalues } = (R * R.transpose()).symmetric_eigen();
                (R.tr_mul(&Q), eigenvalues)
            }
            _ => {
                let SymmetricEigen { eigenvectors: mut Q, eigenvalues } = problem.G.clone().symmetric_eigen();
                for (mut column, value) in Q.column_iter_mut().zip(&eigenvalues) {
                    column *= Scalar::sqrt(value.max(0.0));
                }
                (Q, eigenvalues)
            }
        };
        let largest = squares.max().max(f64::MIN_POSITIVE);
        let positive = squares.iter().filter(|x| **x > 1e-9 * largest).fold(largest, |least, x| least.min(*x));
        let rho = Scalar::sqrt(positive.max(1e-3 * largest) * largest);
        let mut y = guess.clone();
        problem.project(&mut y);
        let z = problem.velocity(guess);
        Admm { p: guess.clone(), y, z, rho, largest, W, squares, iterations: 0, done: false }
    }

    /// The latest impulses that are admissible.
    pub fn impulses(&self) -> &DVector<f64> {
        &self.y
    }

    /// True once both residuals are below the tolerance.
    pub fn is_done(&self) -> bool {
        self.done
    }

    /// At most this many iterations; returns their number.
    pub fn iterate(&mut self, problem: &Problem, tolerance: f64, most: usize) -> usize {
        let eta = PROXIMAL * self.largest;
        for done in 1..=most {
            let mut right = &self.p * eta + &self.y * self.rho + &self.z - &problem.b;
            for (first, law) in problem.blocks() {
                right[first] -= law.shift(&self.z.as_slice()[first..first + law.rows()]);
            }
            self.p = self.divided(&right, eta + self.rho);
            let before = core::mem::replace(&mut self.y, &self.p - &self.z / self.rho);
            problem.project(&mut self.y);
            let gap = &self.p - &self.y;
            self.z -= &gap * self.rho;
            let (primal, dual) = (gap.amax(), self.rho * (&self.y - before).amax());
            if (primal * self.largest).max(dual) <= tolerance {
                self.done = true;
                return done;
            }
            self.iterations += 1;
            if self.iterations.is_multiple_of(EVERY) {
                let factor = match (primal * self.rho > APART * dual, dual > APART * primal * self.rho) {
                    (true, _) => 2.0,
                    (_, true) => 0.5,
                    _ => continue,
                };
                self.rho *= factor;
            }
        }
        most
    }

    /// (G + s 1)⁻¹x = (x − W(Λ + s)⁻¹Wᵀx)/s.
    fn divided(&self, x: &DVector<f64>, s: f64) -> DVector<f64> {
        let mut y = self.W.tr_mul(x);
        y.zip_apply(&self.squares, |y, square| *y /= square.max(0.0) + s);
        (x - &self.W * y) / s
    }
}
