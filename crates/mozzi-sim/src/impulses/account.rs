//! An account of the solutions for one-sided forces.

use super::UNSOLVED;
use crate::one_sided::Solution;

/// How well the laws of dry friction, stops and contacts were satisfied along a motion, and at what cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OneSidedAccount {
    /// Steps, or parts of a step, with one-sided forces.
    pub steps: usize,
    /// The largest [residual](crate::one_sided::residual) of a step, m/s or rad/s.
    pub largest_residual: f64,
    /// That of the last step.
    pub last_residual: f64,
    /// Steps whose residual is above 10⁻⁶: their problem may have no solution.
    pub unsolved: usize,
    /// How often a step was halved, because its iteration did not contract, a loop did not close, or the robot would be
    /// lifted by much energy.
    pub halvings: usize,
    /// Steps of the shortest length whose iteration did not contract; they count.
    pub unsettled: usize,
    /// The energy by which positions were lifted, or lowered, onto the planes and limits that they touch, J. It is part
    /// of what the contacts dissipate.
    pub lifted: f64,
    /// The largest number of rows.
    pub most_rows: usize,
    /// Newton steps, Gauss-Seidel sweeps and iterations of the last method, in all solutions.
    pub newton_steps: usize,
    /// Sweeps of Gauss-Seidel.
    pub sweeps: usize,
    /// Iterations of the alternating direction method of multipliers.
    pub admm_iterations: usize,
}

impl OneSidedAccount {
    /// The cost of a solution.
    pub(super) fn add(&mut self, found: &Solution) {
        self.newton_steps += found.newton_steps;
        self.sweeps += found.sweeps;
        self.admm_iterations += found.admm_iterations;
    }

    /// The quality of a solution that counts.
    pub(crate) fn keep(&mut self, residual: f64, rows: usize) {
        self.steps += 1;
        self.last_residual = residual;
        self.largest_residual = if residual <= self.largest_residual { self.largest_residual } else { residual };
        self.unsolved += usize::from(!(residual <= UNSOLVED));
        self.most_rows = self.most_rows.max(rows);
    }
}
