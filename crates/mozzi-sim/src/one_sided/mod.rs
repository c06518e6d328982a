//! One-sided forces at velocity level: dry friction, stops and contacts, together with constraints.
//!
//! A step changes the velocities by impulses p, which the robot applies along the rows of J:
//!
//! > M(θ̇⁺ − θ̇) = Δt F − Jᵀp,  u = −J θ̇⁺ = G p + b,  G = J M⁻¹Jᵀ,  b = −J θ̇_free
//!
//! u is the velocity of the surroundings as seen from the robot; for a contact u_n is the rate of the gap. Each block
//! of rows has a [`Law`] between its p and its u. G (the Delassus matrix) may be singular: p is then not unique, u is.
//!
//! [`solve`] takes semi-smooth Newton steps from a guess (Alart and Curnier 1991), with a proximal term whose weight
//! falls; then sweeps of projected Gauss-Seidel that solve each contact exactly, then the alternating direction method
//! of multipliers (Carpentier, Le Lidec and Montaut 2024), each followed by Newton steps again. It returns the best p
//! and its [`residual`]. A problem may have no solution, for example if no velocity opens all contacts; the residual
//! then remains.

mod admm;
mod derivative;
mod law;
mod newton;
mod point_contact;
mod scaled;
mod sweeps;
#[cfg(test)]
mod tests;

pub use law::Law;

use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};
use scaled::Scaled;

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
    /// See [`residual`].
    pub residual: f64,
    /// Newton steps.
    pub newton_steps: usize,
    /// Sweeps of Gauss-Seidel.
    pub sweeps: usize,
    /// Iterations of the alternating direction method of multipliers.
    pub admm_iterations: usize,
}

/// ε of Newton steps from a good guess, and from any; so many without a better result are the last.
const NEAR: (&[f64], usize) = (&[1e-8; 6], 2);
const FAR: (&[f64], usize) = (&WEIGHTS, 12);
const WEIGHTS: [f64; 25] = {
    let mut weights = [1e-6; 25];
    let mut k = 0;
    while k < 10 {
        weights[k] = if k < 4 {
            1e-3
        } else if k < 7 {
            1e-4
        } else {
            1e-5
        };
        k += 1;
    }
    weights
};
/// Sweeps before the last method.
const SWEEPS: usize = 20;
/// A residual of at most this many times what is sought is good where a step does not make it a tenth: redundant
/// impulses on the edges of their cones converge no faster. Sweeps follow where Newton's method leaves more.
const CLOSE: f64 = 1e3;
/// Iterations of the last method between Newton steps, and the number of such rounds.
const ADMM_CHUNK: usize = 300;
const ADMM_ROUNDS: usize = 5;

impl Problem {
    /// u = G p + b.
    pub fn velocity(&self, p: &DVector<f64>) -> DVector<f64> {
        let mut u = self.b.clone();
        u.gemv(1.0, &self.G, p, 1.0);
        u
    }

    /// The laws with their first rows.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, Law)> + '_ {
        blocks(&self.laws)
    }

    /// Makes impulses admissible.
    fn project(&self, p: &mut DVector<f64>) {
        for (first, law) in self.blocks() {
            law.project(&mut p.as_mut_slice()[first..first + law.rows()]);
        }
    }
}

/// The laws with their first rows.
fn blocks(laws: &[Law]) -> impl Iterator<Item = (usize, Law)> + '_ {
    let mut next = 0;
    laws.iter().map(move |&law| {
        let first = next;
        next += law.rows();
        (first, law)
    })
}

/// How far impulses are from a solution, a velocity: the largest g|F_r| over the rows, with g the mean of the block's
/// diagonal of G, and with G scaled to 1 there F = u where a block holds, else p less the impulse that its law makes of
/// p − u. It is 0 exactly for a solution. A contact's friction is limited by μ times its own normal argument (Alart
/// and Curnier 1991): De Saxcé's term μ‖u_t‖ would multiply rounding by μ.
pub fn residual(problem: &Problem, p: &DVector<f64>) -> f64 {
    let mut of = Scaled::new(&problem.G, &problem.laws, None);
    of.begin(&problem.b, p);
    of.residual
}

/// The residual of a scaled problem, in which g is 1. Each row's error is multiplied by its factor.
fn residual_with(problem: &Problem, factors: &[f64], p: &DVector<f64>) -> f64 {
    let errors = newton::Function::at(problem, p).F;
    let largest = |most: f64, error: f64| if error <= most { most } else { error }; // NaN passes
    errors.iter().zip(factors).map(|(error, factor)| error.abs() * factor).fold(0.0, largest)
}

/// Impulses from a guess of m numbers, whose residual is at most `sought`; at most `enough` where Newton steps and
/// sweeps do not give more; or the best that were found, after at most 1500 iterations of the last method.
///
/// # Panics
/// When the guess is not m long.
pub fn solve(problem: &Problem, guess: &DVector<f64>, tolerances: [f64; 2]) -> Solution {
    Solver::new(&problem.G, &problem.laws, None).solve(&problem.b, guess, tolerances)
}

/// One G and its laws, for one b after the other.
pub(crate) struct Solver {
    is_finite: bool,
    of: Scaled,
    /// The last derivative of Newton's method: its own, or that of a problem near this one.
    derivative: Option<derivative::Derivative>,
    /// True after a search that did not find enough: the next one, from its best, has one round of the last method.
    is_hard: bool,
    /// True after a search that found enough, but was not close: sweeps do not help the next one.
    is_redundant: bool,
}

impl Solver {
    /// With R of G = RᵀR, n × m, if it is known.
    pub fn new(G: &DMatrix<f64>, laws: &[Law], root: Option<DMatrix<f64>>) -> Self {
        let is_finite = G.iter().all(|x| x.is_finite());
        Solver { is_finite, of: Scaled::new(G, laws, root), derivative: None, is_hard: false, is_redundant: false }
    }

    /// Begins with the derivative of a solver for nearly this G and these laws.
    pub fn begin_as(&mut self, other: Solver) {
        if self.of.is_scaled_as(&other.of) {
            (self.derivative, self.is_redundant) = (other.derivative, other.is_redundant);
        }
    }

    /// As [`solve`].
    pub fn solve(&mut self, b: &DVector<f64>, guess: &DVector<f64>, [sought, enough]: [f64; 2]) -> Solution {
        let Solver { is_finite, of, derivative, is_hard, is_redundant } = self;
        let m = b.len();
        assert!(guess.len() == m, "the guess has {} entries, expected {m}", guess.len());
        let mut found = Solution { p: guess.clone(), residual: 0.0, newton_steps: 0, sweeps: 0, admm_iterations: 0 };
        if m == 0 {
            return found;
        }
        if !(*is_finite && b.iter().all(|x| x.is_finite())) {
            found.residual = f64::NAN;
            return found;
        }
        of.begin(b, guess);
        if !of.residual.is_finite() {
            of.begin(b, &DVector::zeros(m));
        }
        let mut newton = |of: &mut Scaled, p: DVector<f64>, schedule: (&[f64], usize)| {
            found.newton_steps += newton::newton(of, derivative, p, schedule, sought);
        };
        newton(of, of.best.clone(), NEAR);
        if of.residual > CLOSE * sought {
            newton(of, of.best.clone(), FAR);
        }
        if of.residual > if *is_redundant { enough } else { enough.min(CLOSE * sought) } {
            let mut p = of.best.clone();
            found.sweeps = sweeps::sweep(&of.problem, &mut p, sought, SWEEPS);
            of.offer(&p);
            newton(of, p, NEAR);
        }
        if of.residual > enough {
            let mut method = admm::Admm::new(&of.problem, of.root.as_ref(), &of.best);
            for _ in 0..if *is_hard { 1 } else { ADMM_ROUNDS } {
                found.admm_iterations += method.iterate(&of.problem, sought, ADMM_CHUNK);
                let p = method.impulses().clone();
                of.offer(&p);
                newton(of, p, FAR);
                if of.residual <= enough || method.is_done() {
                    break;
                }
            }
            *is_hard = of.residual > enough;
        }
        *is_redundant = of.residual > CLOSE * sought;
        (found.p, found.residual) = (of.impulses(), of.residual);
        found
    }
}
