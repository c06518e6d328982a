//! One-sided forces at velocity level: dry friction, stops and contacts, together with constraints.
//!
//! A step changes the velocities by impulses p, which the robot applies along the rows of J:
//!
//! > M(θ̇⁺ − θ̇) = Δt F − Jᵀp,  u = −J θ̇⁺ = G p + b,  G = J M⁻¹Jᵀ,  b = −J θ̇_free
//!
//! u is the velocity of the surroundings as seen from the robot; for a contact u_n is the rate of the gap. Each block
//! of rows has a [`Law`] between its p and its u. G (the Delassus matrix) may be singular: p is then not unique, u is.
//!
//! [`solve`] takes semi-smooth Newton steps from a guess (Alart and Curnier 1991), then sweeps of projected
//! Gauss-Seidel that solve each contact exactly, then the alternating direction method of multipliers (Carpentier, Le
//! Lidec and Montaut 2024). It returns the best p and its [`residual`]. A problem may have no solution, for example if
//! no velocity opens all contacts; the residual then remains.

mod admm;
mod law;
mod newton;
mod point_contact;
mod sweeps;
#[cfg(test)]
mod tests;

pub use law::Law;
pub(crate) use newton::least_squares;

use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// G, b and the laws of the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// G = J M⁻¹Jᵀ, m × m: symmetric, positive semidefinite.
    pub G: DMatrix<f64>,
    /// b = −J θ̇_free, m: u without impulses.
    pub b: DVector<f64>,
    /// The laws, in the order of the rows; together they have m rows.
    pub laws: Vec<Law>,
}

/// Impulses, and how they were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// p, m: N s and N m s.
    pub p: DVector<f64>,
    /// The natural residual of p: see [`residual`].
    pub residual: f64,
    /// Newton steps.
    pub newton_steps: usize,
    /// Sweeps of Gauss-Seidel.
    pub sweeps: usize,
    /// Iterations of the alternating direction method of multipliers.
    pub admm_iterations: usize,
}

/// Newton steps from one guess.
const NEWTON_STEPS: usize = 6;
/// Sweeps before the last method.
const SWEEPS: usize = 20;
/// The last method is used if the residual is above this many tolerances.
const ENOUGH: f64 = 100.0;
/// Iterations of the last method between two Newton polishes, and the number of such rounds.
const ADMM_CHUNK: usize = 100;
const ADMM_ROUNDS: usize = 60;

impl Problem {
    /// u = G p + b.
    pub fn velocity(&self, p: &DVector<f64>) -> DVector<f64> {
        &self.G * p + &self.b
    }

    /// The laws with their first rows.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, Law)> + '_ {
        let mut next = 0;
        self.laws.iter().map(move |&law| {
            let first = next;
            next += law.rows();
            (first, law)
        })
    }

    /// g of each row: the mean diagonal entry of G in the row's block. 1 for a block that nothing moves.
    pub(crate) fn scales(&self) -> Vec<f64> {
        let mut scales = Vec::with_capacity(self.b.len());
        for (first, law) in self.blocks() {
            let rows = law.rows();
            let mean = (first..first + rows).map(|r| self.G[(r, r)]).sum::<f64>() / rows as f64;
            scales.extend(core::iter::repeat_n(if mean > 0.0 { mean } else { 1.0 }, rows));
        }
        scales
    }
}

/// The natural residual of impulses, a velocity: max g ‖p − Π_K(p − (u + s)/g)‖ over the rows, with s = μ‖u_t‖ along
/// the normal of a contact (De Saxcé and Feng 1998) and g the mean of the block's diagonal of G. It is 0 exactly for a
/// solution.
pub fn residual(problem: &Problem, p: &DVector<f64>) -> f64 {
    residual_with(problem, &problem.scales(), p)
}

fn residual_with(problem: &Problem, scales: &[f64], p: &DVector<f64>) -> f64 {
    let u = problem.velocity(p);
    let (mut most, mut x) = (0.0_f64, [0.0; 3]);
    for (first, law) in problem.blocks() {
        let (rows, g) = (first..first + law.rows(), scales[first]);
        let shift = law.shift(&u.as_slice()[rows.clone()]);
        let x = &mut x[..law.rows()];
        for (k, r) in rows.clone().enumerate() {
            x[k] = p[r] - (u[r] + if k == 0 { shift } else { 0.0 }) / g;
        }
        law.project(x);
        for (k, r) in rows.enumerate() {
            let error = (p[r] - x[k]).abs() * g;
            most = if error <= most { most } else { error }; // NaN passes
        }
    }
    most
}

/// Impulses from a guess of m numbers, whose residual is at most `tolerance`; if Newton's method and the sweeps do not
/// get there, at most 100 times that; or the best that were found. At most 6,000 iterations.
///
/// # Panics
/// When the guess is not m long.
pub fn solve(problem: &Problem, guess: &DVector<f64>, tolerance: f64) -> Solution {
    let scales = problem.scales();
    let m = problem.b.len();
    assert!(guess.len() == m, "the guess has {} entries, expected {m}", guess.len());
    let mut best = Solution {
        p: guess.clone(),
        residual: residual_with(problem, &scales, guess),
        newton_steps: 0,
        sweeps: 0,
        admm_iterations: 0,
    };
    let is_finite = problem.G.as_slice().iter().chain(problem.b.as_slice()).all(|x| x.is_finite());
    if !is_finite {
        best.residual = f64::NAN;
    }
    if m == 0 || !is_finite || best.residual <= tolerance {
        return best;
    }
    if !best.residual.is_finite() {
        best.p.fill(0.0);
        best.residual = residual_with(problem, &scales, &best.p);
    }
    best.polish(problem, &scales, best.p.clone(), tolerance);
    if best.residual > tolerance {
        let mut p = best.p.clone();
        best.sweeps += sweeps::sweep(problem, &mut p, tolerance, SWEEPS);
        best.polish(problem, &scales, p, tolerance);
    }
    if best.residual > ENOUGH * tolerance {
        let mut method = admm::Admm::new(problem, &best.p);
        for _ in 0..ADMM_ROUNDS {
            best.admm_iterations += method.iterate(problem, tolerance, ADMM_CHUNK);
            best.polish(problem, &scales, method.impulses().clone(), tolerance);
            if best.residual <= tolerance || method.is_done() {
                break;
            }
        }
    }
    best
}

impl Solution {
    /// Newton steps from p; keeps the result if it is better.
    fn polish(&mut self, problem: &Problem, scales: &[f64], p: DVector<f64>, tolerance: f64) {
        let (found, residual, steps) = newton::polish(problem, scales, p, tolerance, NEWTON_STEPS);
        self.newton_steps += steps;
        if residual < self.residual {
            (self.p, self.residual) = (found, residual);
        }
    }
}
