//! Semi-smooth Newton steps on Alart and Curnier's function (1991), made regular by a proximal term:
//!
//! > (F'(p) + ε)(p⁺ − p) = −F(p) − ε(p − p̄)
//!
//! p̄ are the best admissible impulses so far, so that the term vanishes at a solution, and impulses that are not
//! unique stay where they were. p is not projected between the steps: Newton's method is one on all p. Only Π(p) is
//! offered as a result. Rows are scaled to a G of about 1 on the diagonal. A derivative that was factored serves again
//! for as long as no block changes sides and the residual falls tenfold.

use super::law::norm;
use super::scaled::Scaled;
use super::{CLOSE, Law, Problem};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// So many steps without a better result are the last.
const STALLS: usize = 12;
/// A step is good if the residual falls to this part. So many others are the last where it is close.
const GOOD: f64 = 0.1;
const SLOW: usize = 3;

/// A step for each ε, from p, as long as results get better. Returns their number; the best is kept in `of`.
pub(super) fn newton(
    of: &mut Scaled,
    last: &mut Option<Derivative>,
    mut p: DVector<f64>,
    weights: &[f64],
    tolerance: f64,
) -> usize {
    let (mut improved, mut good) = (0, 0);
    repeat(of, last.as_ref(), &mut p, tolerance);
    for (done, &weight) in weights.iter().enumerate() {
        if of.residual <= tolerance || done > improved + STALLS {
            return done;
        }
        let before = of.residual;
        let at = Function::at(&of.problem, &p);
        let derivative = last.insert(Derivative::new(&of.problem, &p, &at, weight));
        let Some(step) = derivative.step(&p, &at.F, &of.best) else {
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
        if at.sides != derivative.sides {
            return;
        }
        let Some(step) = derivative.step(p, &at.F, &of.best) else { return };
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
enum Side {
    /// At its bound.
    Bound,
    /// Where u = 0.
    Holds,
    /// Beyond a contact's friction disc.
    Slides,
}

/// F(p): u where a block holds, p − Π(p − u) elsewhere. The radius of a contact's disc is μ times its normal argument.
pub(super) struct Function {
    u: DVector<f64>,
    pub F: DVector<f64>,
    /// One for each block.
    sides: Vec<Side>,
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

/// A generalized derivative F' + ε of F, factored.
pub(super) struct Derivative {
    sides: Vec<Side>,
    weight: f64,
    /// The rows that are not at their bounds, where F' is not just 1 on the diagonal.
    free: Vec<usize>,
    /// Their F', a column each.
    A: DMatrix<f64>,
    lu: LU<f64, Dyn, Dyn>,
}

impl Derivative {
    fn new(problem: &Problem, p: &DVector<f64>, at: &Function, weight: f64) -> Self {
        let (G, m) = (&problem.G, p.len());
        let (mut free, mut A) = (Vec::with_capacity(m), Vec::with_capacity(m * m));
        let row = |r: usize| &G.as_slice()[r * m..][..m]; // symmetric
        for ((i, law), side) in problem.blocks().zip(&at.sides) {
            let held = match side {
                Side::Bound => continue,
                Side::Holds => law.rows(),
                Side::Slides => 1,
            };
            for r in i..i + held {
                free.push(r);
                A.extend_from_slice(row(r));
            }
            let (Side::Slides, Law::Contact { mu }) = (side, law) else { continue };
            let [x_n, x_1, x_2] = [i, i + 1, i + 2].map(|r| p[r] - at.u[r]);
            let (size, radius) = (norm(x_1, x_2), mu * x_n);
            let (d, [g_n, g_1, g_2]) = ([x_1 / size, x_2 / size], [i, i + 1, i + 2].map(row));
            let turn = radius / size;
            for k in 0..2 {
                free.push(i + 1 + k);
                // 1 − ∂(radius d_k)/∂p: by ∂x/∂p = 1 − G, its part of G and that of 1
                let (start, along) = (A.len(), turn * d[k]);
                A.extend_from_slice([g_1, g_2][k]);
                for (c, a) in A[start..].iter_mut().enumerate() {
                    *a = turn * *a + mu * d[k] * g_n[c] - along * (d[0] * g_1[c] + d[1] * g_2[c]);
                }
                let block = &mut A[start + i..][..3];
                block[0] -= mu * d[k];
                block[1] += along * d[0];
                block[2] += along * d[1];
                block[1 + k] += 1.0 - turn;
            }
        }
        let A = DMatrix::from_vec(m, free.len(), A);
        let B = DMatrix::from_fn(free.len(), free.len(), |i, j| A[(free[j], i)] + if i == j { weight } else { 0.0 });
        Derivative { sides: at.sides.clone(), weight, free, A, lu: B.lu() }
    }

    /// p⁺ − p. Rows at their bounds give theirs at once, −F; a system of the others remains.
    fn step(&self, p: &DVector<f64>, F: &DVector<f64>, best: &DVector<f64>) -> Option<DVector<f64>> {
        let mut x = -F;
        if self.free.is_empty() {
            return Some(x);
        }
        self.free.iter().for_each(|&r| x[r] = 0.0);
        let mut right = -(F.select_rows(&self.free) + self.A.tr_mul(&x));
        self.free.iter().enumerate().for_each(|(i, &r)| right[i] -= self.weight * (p[r] - best[r]));
        if !self.lu.solve_mut(&mut right) {
            return None;
        }
        self.free.iter().enumerate().for_each(|(i, &r)| x[r] = right[i]);
        Some(x)
    }
}
