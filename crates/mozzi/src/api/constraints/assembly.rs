//! Positions, velocities and accelerations that satisfy the constraints.

use super::{Rows, columns, least_squares};
use crate::kinematics::integrate;
use crate::model::{Error, Model};
use crate::random::Random;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A residual below this is rounding, rad and m.
const CLOSED: f64 = 1e-11;
/// Maximum number of steps from one start.
const STEPS: usize = 100;
/// Number of further starts around the guess if it does not converge.
const STARTS: usize = 24;

impl Model<f64> {
    /// θ near a guess at which the constraints hold, φ(θ) = 0, while the joints named in `hold` keep their positions.
    /// By Levenberg and Marquardt's method; if it does not converge from the guess, from starts around it.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`]; [`Error::Unreachable`] with the constraint of the largest
    /// residual, and the residual.
    pub fn assemble(&self, guess: &[f64], hold: &[&str]) -> Result<Vec<f64>, Error> {
        self.check_configuration(guess)?;
        let free = self.free_velocities(hold)?;
        let mut random = Random(1);
        let mut best: Option<(f64, Vec<f64>)> = None;
        for start in 0..=STARTS {
            let mut theta = guess.to_vec();
            if start > 0 {
                let size = 0.2 * start as f64;
                let mut away = alloc::vec![0.0; self.n()];
                free.iter().for_each(|&j| away[j] = size * random.next());
                integrate(self, &mut theta, &away, 1.0);
            }
            let residual = self.close(&mut theta, &free);
            if residual < CLOSED {
                return Ok(theta);
            }
            if best.as_ref().is_none_or(|(least, _)| residual < *least) {
                best = Some((residual, theta));
            }
        }
        let (residual, theta) = best.unwrap_or((f64::NAN, guess.to_vec()));
        let phi = self.constraint_rows_at(&theta, &alloc::vec![0.0; self.n()]).phi;
        let row = phi.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(0, |(row, _)| row);
        let what = if hold.is_empty() { "no position" } else { "no position with the held joints" };
        Err(Error::Unreachable { constraint: self.constraint_of_row(row), residual, what })
    }

    /// Closes the loops by moving the `free` velocities; returns the largest residual.
    fn close(&self, theta: &mut Vec<f64>, free: &[usize]) -> f64 {
        let (n, at_rest) = (self.n(), alloc::vec![0.0; self.n()]);
        let (mut damping, mut last) = (1e-6, self.constraint_rows_at(theta, &at_rest));
        for _ in 0..STEPS {
            let size = last.phi.amax();
            if size < 1e-15 || last.phi.is_empty() {
                break;
            }
            let A = columns(&last.A, free);
            let mut G = &A * A.transpose();
            let mean = G.trace() / G.nrows() as f64;
            (0..G.nrows()).for_each(|r| G[(r, r)] += damping * mean + f64::MIN_POSITIVE);
            let Some(G) = G.cholesky() else {
                damping *= 10.0;
                continue;
            };
            let step = A.transpose() * G.solve(&last.phi);
            let mut change = alloc::vec![0.0; n];
            free.iter().zip(step.iter()).for_each(|(&j, x)| change[j] = -x);
            let mut next = theta.clone();
            integrate(self, &mut next, &change, 1.0);
            let rows = self.constraint_rows_at(&next, &at_rest);
            if rows.phi.norm() < last.phi.norm() {
                (*theta, last, damping) = (next, rows, (damping * 0.1_f64).max(1e-14));
            } else if size < CLOSED || damping > 1e8 {
                break;
            } else {
                damping *= 10.0;
            }
        }
        last.phi.amax()
    }

    /// θ̇ nearest to a guess with A(θ)θ̇ = 0, while the joints named in `hold` keep their velocities.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`]; [`Error::Unreachable`] if the constraints forbid these held
    /// velocities.
    pub fn assemble_velocities(&self, theta: &[f64], guess: &[f64], hold: &[&str]) -> Result<Vec<f64>, Error> {
        self.check_lengths(theta, [("dtheta", guess)])?;
        let Rows { A, .. } = self.constraint_rows_at(theta, guess);
        let target = DVector::zeros(A.nrows());
        self.nearest(A, target, guess, hold, "no velocity with the held joints")
    }

    /// θ̈ nearest to a guess with A(θ)θ̈ + Ȧ(θ, θ̇)θ̇ = 0, while the joints named in `hold` keep their accelerations.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`]; [`Error::Unreachable`] if the constraints forbid these held
    /// accelerations.
    pub fn assemble_accelerations(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        guess: &[f64],
        hold: &[&str],
    ) -> Result<Vec<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", guess)])?;
        let Rows { A, bias, .. } = self.constraint_rows_at(theta, dtheta);
        self.nearest(A, -bias, guess, hold, "no acceleration with the held joints")
    }

    /// x nearest to a guess with Ax = b.
    fn nearest(
        &self,
        A: DMatrix<f64>,
        b: DVector<f64>,
        guess: &[f64],
        hold: &[&str],
        what: &'static str,
    ) -> Result<Vec<f64>, Error> {
        let free = self.free_velocities(hold)?;
        let residual = |x: &[f64]| &A * DVector::from_column_slice(x) - &b;
        let mut x = guess.to_vec();
        for _ in 0..2 {
            // the second pass removes the rounding error of the first
            let change = least_squares(&columns(&A, &free), &residual(&x));
            free.iter().zip(change.iter()).for_each(|(&j, change)| x[j] -= change);
        }
        let (left, size) = (residual(&x), guess.iter().chain(b.iter()).fold(1.0_f64, |m, x| m.max(x.abs())));
        match left.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
            Some((row, &residual)) if !(residual.abs() < 1e-8 * size) => {
                Err(Error::Unreachable { constraint: self.constraint_of_row(row), residual: residual.abs(), what })
            }
            _ => Ok(x),
        }
    }

    /// The velocities of joints that are not held, including those of a floating base.
    fn free_velocities(&self, hold: &[&str]) -> Result<Vec<usize>, Error> {
        let held = self.velocities_of(hold)?;
        Ok((0..self.n()).filter(|j| !held.contains(j)).collect())
    }
}
