//! Semi-smooth Newton steps on Alart and Curnier's function (1991), made regular by a proximal term:
//!
//! > (F'(p) + ε)(p⁺ − p) = −F(p) − ε(p − p̄)
//!
//! p̄ are the best admissible impulses so far, so that the term vanishes at a solution, and impulses that are not
//! unique stay where they were. p is not projected between the steps: Newton's method is one on all p. Only Π(p) is
//! offered as a result. Rows are scaled to a G of about 1 on the diagonal.

use super::law::norm;
use super::scaled::Scaled;
use super::{Law, Problem};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// So many steps without a better result are the last.
const STALLS: usize = 12;

/// A step for each ε, from p, as long as results get better. Returns their number; the best is kept in `of`.
pub(super) fn newton(of: &mut Scaled, mut p: DVector<f64>, weights: &[f64], tolerance: f64) -> usize {
    let mut improved = 0;
    for (done, &weight) in weights.iter().enumerate() {
        if of.residual <= tolerance || done > improved + STALLS {
            return done;
        }
        let Some(step) = step(&of.problem, &p, &of.best, weight) else { return done };
        p += step;
        if !p.iter().all(|x| x.is_finite()) {
            return done + 1;
        }
        if of.offer(&p) {
            improved = done;
        }
    }
    weights.len()
}

/// p⁺ − p. Rows at their bounds give theirs at once, −F; a system of the others remains.
fn step(problem: &Problem, p: &DVector<f64>, best: &DVector<f64>, weight: f64) -> Option<DVector<f64>> {
    let Linear { F, free, A } = linearized(problem, p);
    let mut x = -&F;
    if free.is_empty() {
        return Some(x);
    }
    free.iter().for_each(|&r| x[r] = 0.0);
    let mut right = -(F.select_rows(&free) + A.tr_mul(&x));
    free.iter().enumerate().for_each(|(i, &r)| right[i] -= weight * (p[r] - best[r]));
    let B = DMatrix::from_fn(free.len(), free.len(), |i, j| A[(free[j], i)] + if i == j { weight } else { 0.0 });
    let found = B.lu().solve(&right)?;
    free.iter().enumerate().for_each(|(i, &r)| x[r] = found[i]);
    Some(x)
}

/// F(p) and its generalized derivative: rows are u for active laws, p − Π(p − u) for others. The radius of a contact's
/// disc is μ times its normal argument, so that De Saxcé's term is not needed.
struct Linear {
    F: DVector<f64>,
    /// The rows that are not at their bounds, where F' is not just 1 on the diagonal.
    free: Vec<usize>,
    /// Their F', a column each.
    A: DMatrix<f64>,
}

fn linearized(problem: &Problem, p: &DVector<f64>) -> Linear {
    let (G, u, m) = (&problem.G, problem.velocity(p), p.len());
    let (mut F, mut free, mut A) = (DVector::zeros(m), Vec::with_capacity(m), Vec::with_capacity(m * m));
    let row = |r: usize| &G.as_slice()[r * m..][..m]; // symmetric
    for (i, law) in problem.blocks() {
        let argument = |r: usize| p[r] - u[r];
        let mut velocity = |r: usize| {
            F[r] = u[r];
            free.push(r);
            A.extend_from_slice(row(r));
        };
        let Law::Contact { mu } = law else {
            let mut x = [argument(i)];
            law.project(&mut x);
            if x[0] == argument(i) && (law == Law::Bilateral || !is_at_bound(law, x[0])) {
                velocity(i);
            } else {
                F[i] = p[i] - x[0];
            }
            continue;
        };
        let x_n = argument(i);
        if x_n <= 0.0 {
            (i..i + 3).for_each(|r| F[r] = p[r]);
            continue;
        }
        velocity(i);
        let (x_1, x_2) = (argument(i + 1), argument(i + 2));
        let (size, radius) = (norm(x_1, x_2), mu * x_n);
        if size <= radius {
            velocity(i + 1);
            velocity(i + 2);
            continue;
        }
        let (d, [g_n, g_1, g_2]) = ([x_1 / size, x_2 / size], [i, i + 1, i + 2].map(row));
        let turn = radius / size;
        for k in 0..2 {
            F[i + 1 + k] = p[i + 1 + k] - radius * d[k];
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
    Linear { F, free, A }
}

fn is_at_bound(law: Law, x: f64) -> bool {
    match law {
        Law::Stop => x <= 0.0,
        Law::Dry { most } => x.abs() >= most,
        _ => false,
    }
}
