//! The alternating direction method of multipliers for cone complementarity with De Saxcé's term (Carpentier, Le Lidec
//! and Montaut 2024).

use super::Problem;
use mozzi::scalar::Scalar;
use nalgebra::{DVector, Dyn, SymmetricEigen};

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
    spectrum: SymmetricEigen<f64, Dyn>,
    iterations: usize,
    done: bool,
}

impl Admm {
    pub fn new(problem: &Problem, guess: &DVector<f64>) -> Self {
        let spectrum = problem.G.clone().symmetric_eigen();
        let values = &spectrum.eigenvalues;
        let largest = values.max().max(f64::MIN_POSITIVE);
        let positive = values.iter().filter(|x| **x > 1e-9 * largest).fold(largest, |least, x| least.min(*x));
        let rho = Scalar::sqrt(positive.max(1e-3 * largest) * largest);
        let mut y = guess.clone();
        problem.project(&mut y);
        let z = problem.velocity(guess);
        Admm { p: guess.clone(), y, z, rho, largest, spectrum, iterations: 0, done: false }
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

    /// (G + shift 1)⁻¹x = Q(Λ + shift 1)⁻¹Qᵀx.
    fn divided(&self, x: &DVector<f64>, shift: f64) -> DVector<f64> {
        let SymmetricEigen { eigenvectors: Q, eigenvalues } = &self.spectrum;
        let mut y = Q.tr_mul(x);
        y.zip_apply(eigenvalues, |y, value| *y /= value.max(0.0) + shift);
        Q * y
    }
}
