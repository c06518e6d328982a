//! Positions, velocities and accelerations that satisfy the constraints.

use super::rows::{Rows, columns, least_squares};
use crate::model::description::JointKind;
use crate::model::{Bounds, Error, Freedom, Model, Tie};
use crate::model::{difference, integrate};
use crate::random::Random;
use alloc::string::String;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A residual below this is rounding, rad and m.
const CLOSED: f64 = 1e-11;
/// Maximum number of steps from one start.
const STEPS: usize = 100;
/// The longest step, rad and m.
const LONGEST: f64 = core::f64::consts::FRAC_PI_4;
/// Steps of held joints.
const MOST_STEPS: u32 = 64;
const TURN: f64 = 2.0 * core::f64::consts::PI;
/// Number of further starts around the guess if it does not converge.
const STARTS: usize = 24;

impl Model<f64> {
    /// θ near a guess at which the constraints hold, φ(θ) = 0, while the joints named in `hold` keep their positions:
    /// the nearest that is found within the limits, with angles within ± π of the guess. By Levenberg and Marquardt's
    /// method in steps of at most 45°, from the guess, and from where the loops close with all joints free, along a
    /// straight way of the held joints; if neither is within the limits, from starts around the guess.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`]; [`Error::Unreachable`] with the constraint of the largest
    /// residual, and the residual; [`Error::BadArgument`] naming the limit that stands in the way.
    pub fn assemble(&self, guess: &[f64], hold: &[&str]) -> Result<Vec<f64>, Error> {
        self.check_configuration(guess)?;
        let free = self.free_velocities(hold)?;
        self.check_rows(&self.constraint_rows_at(guess, &alloc::vec![0.0; self.n()]))?;
        let (mut random, mut best, mut beyond) = (Random(1), None::<(f64, Vec<f64>)>, None);
        let mut nearest = None::<(f64, Vec<f64>)>;
        for start in 0..=STARTS + 1 {
            let mut theta = guess.to_vec();
            let residual = match start {
                0 => self.close(&mut theta, &free),
                1 if free.len() == self.n() => continue,
                1 => self.close_along(&mut theta, guess, &free),
                _ if nearest.is_some() => break,
                _ => {
                    let size = 0.2 * (start - 1) as f64;
                    let mut away = alloc::vec![0.0; self.n()];
                    free.iter().for_each(|&j| away[j] = size * random.next());
                    integrate(self, &mut theta, &away, 1.0);
                    self.close(&mut theta, &free)
                }
            };
            if residual < CLOSED {
                let theta = self.unwound(theta, guess);
                if let Some(limit) = self.limit_in_the_way(&theta, guess) {
                    beyond = beyond.or(Some(limit));
                    continue;
                }
                let mut way = alloc::vec![0.0; self.n()];
                difference(self, guess, &theta, &mut way);
                let far = way.iter().map(|x| x * x).sum::<f64>();
                if nearest.as_ref().is_none_or(|(least, _)| far < *least) {
                    nearest = Some((far, theta));
                }
            } else if best.as_ref().is_none_or(|(least, _)| residual < *least) {
                best = Some((residual, theta));
            }
        }
        if let Some((_, theta)) = nearest {
            return Ok(theta);
        }
        if let Some(found) = beyond {
            let expected = "one within its limits: none was found near the guess";
            return Err(Error::BadArgument { what: "the closed position", found, expected });
        }
        let (residual, theta) = best.unwrap_or((f64::NAN, guess.to_vec()));
        let phi = self.constraint_rows_at(&theta, &alloc::vec![0.0; self.n()]).phi;
        let gap = |tie: &Tie<f64>| phi.rows(tie.first, tie.kind.rows()).norm();
        let worst = self.ties.list.iter().max_by(|a, b| gap(a).total_cmp(&gap(b)));
        let (row, residual) = worst.map_or((0, residual), |tie| (tie.first, gap(tie)));
        let what = if hold.is_empty() { "no position" } else { "no position with the held joints" };
        Err(Error::Unreachable { constraint: self.constraint_of_row(row), residual, what })
    }

    /// Closes the loops with all joints free, then brings those that are not free to the guess, in steps.
    fn close_along(&self, theta: &mut Vec<f64>, guess: &[f64], free: &[usize]) -> f64 {
        let all: Vec<usize> = (0..self.n()).collect();
        let mut residual = self.close(theta, &all);
        let mut way = alloc::vec![0.0; self.n()];
        difference(self, theta, guess, &mut way);
        free.iter().for_each(|&j| way[j] = 0.0);
        let longest = way.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let count = (1..MOST_STEPS).find(|&count| longest <= LONGEST * f64::from(count)).unwrap_or(MOST_STEPS);
        for _ in 0..count {
            integrate(self, theta, &way, 1.0 / f64::from(count));
            residual = self.close(theta, free);
        }
        for place in self.places().iter().filter(|place| !free.contains(&place.j)) {
            theta[place.positions()].copy_from_slice(&guess[place.positions()]); // without the sums' rounding
        }
        residual.max(self.close(theta, free))
    }

    /// Subtracts whole turns from revolute joints, so that each angle is within ± π of the guess.
    fn unwound(&self, theta: Vec<f64>, guess: &[f64]) -> Vec<f64> {
        let mut near = theta.clone();
        for (name, place) in self.joint_names().zip(self.places()) {
            let joint = self.description().joints.iter().find(|joint| joint.name == *name);
            let turns = joint.is_some_and(|joint| match joint.kind {
                JointKind::Screw(axis) => axis.twist().w.norm() > 0.0 && axis.twist().w.dot(axis.twist().v) == 0.0,
                _ => false,
            });
            if turns && place.freedom == Freedom::One {
                let apart = (near[place.q] - guess[place.q]) / TURN;
                let whole = if apart.abs() <= 0.5 { 0.0 } else { libm::floor(apart + 0.5) };
                near[place.q] -= TURN * whole;
            }
        }
        let still = alloc::vec![0.0; self.n()];
        if self.constraint_rows_at(&near, &still).phi.amax() < CLOSED { near } else { theta }
    }

    /// A joint that is beyond its limit, by more than in the guess.
    fn limit_in_the_way(&self, theta: &[f64], guess: &[f64]) -> Option<String> {
        let bounds = Bounds::of(self);
        for ((k, &[low, high]), name) in bounds.joints.iter().enumerate().zip(self.joint_names()) {
            let excess = |theta: &[f64]| (low - bounds.value(theta, k)).max(bounds.value(theta, k) - high);
            if excess(theta) > excess(guess).max(0.0) + 1e-9 {
                let value = bounds.value(theta, k);
                return Some(alloc::format!("`{name}` at {value}, beyond its limits {low} … {high}"));
            }
        }
        None
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
            let shorter = (LONGEST / step.amax().max(f64::MIN_POSITIVE)).min(1.0);
            free.iter().zip(step.iter()).for_each(|(&j, x)| change[j] = -shorter * x);
            let mut next = theta.clone();
            integrate(self, &mut next, &change, 1.0);
            let rows = self.constraint_rows_at(&next, &at_rest);
            if rows.phi.norm() < last.phi.norm() && self.check_rows(&rows).is_ok() {
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
        let rows = self.constraint_rows_at(theta, guess);
        self.check_rows(&rows)?;
        let A = rows.A;
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
        let rows = self.constraint_rows_at(theta, dtheta);
        self.check_rows(&rows)?;
        let Rows { A, bias, .. } = rows;
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
