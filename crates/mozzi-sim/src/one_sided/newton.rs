//! Semi-smooth Newton steps on Alart and Curnier's function (1991), made regular by a proximal term:
//!
//! > (F'(p) + ε)(p⁺ − p) = −F(p) − ε(p − p̄)
//!
//! p̄ are the best admissible impulses so far, so that the term vanishes at a solution, and impulses that are not
//! unique stay where they were. p is not projected between the steps: Newton's method is one on all p. Only Π(p) is
//! offered as a result. Rows are scaled to a G of about 1 on the diagonal. A derivative that was factored serves again
//! for as long as no block changes sides and the residual falls tenfold: also in the next step of a simulation.

use super::derivative::Derivative;
use super::law::norm;
use super::scaled::Scaled;
use super::{CLOSE, Law, Problem};
use alloc::vec::Vec;
use nalgebra::DVector;

/// A step is good if the residual falls to this part. So many others are the last where it is close.
const GOOD: f64 = 0.1;
const SLOW: usize = 3;

/// A step for each ε, from p, until so many give no better result. Returns their number; the best is kept in `of`.
pub(super) fn newton(
    of: &mut Scaled,
    last: &mut Option<Derivative>,
    mut p: DVector<f64>,
    (weights, stalls): (&[f64], usize),
    tolerance: f64,
) -> usize {
    let (mut improved, mut good) = (0, 0);
    repeat(of, last.as_ref(), &mut p, tolerance);
    for (done, &weight) in weights.iter().enumerate() {
        if of.residual <= tolerance || done > improved + stalls {
            return done;
        }
        let before = of.residual;
        let at = Function::at(&of.problem, &p);
        let derivative = last.insert(Derivative::new(of, &p, &at, weight));
        let Some(step) = derivative.step(&of.problem, &p, &at.F, &of.best) else {
            *last = None;
            return done;
        };
        p += step;
        if !p.iter().all(|x| x.is_finite()) {
            *last = None;
            return done + 1;
        }
        if of.offer(&p) {
            improved = done;
        }
        repeat(of, last.as_ref(), &mut p, tolerance);
        if of.residual <= GOOD * before {
            good = done;
        } else if of.residual <= CLOSE * tolerance && done > good + SLOW {
            return done + 1;
        }
    }
    weights.len()
}

/// Steps with a derivative that is known, as long as they are good.
fn repeat(of: &mut Scaled, derivative: Option<&Derivative>, p: &mut DVector<f64>, tolerance: f64) {
    let Some(derivative) = derivative else { return };
    while of.residual > tolerance {
        let (before, at) = (of.residual, Function::at(&of.problem, p));
        if !derivative.is_of(&at) {
            return;
        }
        let Some(step) = derivative.step(&of.problem, p, &at.F, &of.best) else { return };
        let next = &*p + step;
        if !of.offer(&next) {
            return;
        }
        *p = next;
        if of.residual > GOOD * before {
            return;
        }
    }
}

/// Where p − u of a block is.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Side {
    /// At its bound.
    Bound,
    /// Where u = 0.
    Holds,
    /// Beyond a contact's friction disc.
    Slides,
}

/// F(p): u where a block holds, p − Π(p − u) elsewhere. The radius of a contact's disc is μ times its normal argument.
pub(super) struct Function {
    pub u: DVector<f64>,
    pub F: DVector<f64>,
    /// One for each block.
    pub sides: Vec<Side>,
}

impl Function {
    pub fn at(problem: &Problem, p: &DVector<f64>) -> Self {
        let u = problem.velocity(p);
        let (mut F, mut sides) = (u.clone(), Vec::with_capacity(problem.laws.len()));
        for (i, law) in problem.blocks() {
            let argument = |r: usize| p[r] - u[r];
            let x = argument(i);
            sides.push(match law {
                Law::Bilateral => Side::Holds,
                Law::Stop if x > 0.0 => Side::Holds,
                Law::Dry { most } if x.abs() < most => Side::Holds,
                Law::Stop | Law::Dry { .. } => {
                    let mut bound = [x];
                    law.project(&mut bound);
                    F[i] = p[i] - bound[0];
                    Side::Bound
                }
                Law::Contact { .. } if x <= 0.0 => {
                    (i..i + 3).for_each(|r| F[r] = p[r]);
                    Side::Bound
                }
                Law::Contact { mu } => {
                    let way = [argument(i + 1), argument(i + 2)];
                    let (size, radius) = (norm(way[0], way[1]), mu * x);
                    if size <= radius {
                        Side::Holds
                    } else {
                        (0..2).for_each(|k| F[i + 1 + k] = p[i + 1 + k] - radius * way[k] / size);
                        Side::Slides
                    }
                }
            });
        }
        Function { u, F, sides }
    }
}
