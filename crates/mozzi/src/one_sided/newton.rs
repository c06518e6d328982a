//! Semi-smooth Newton steps on Alart and Curnier's function (1991), with least squares for the step because G may be
//! singular.

use super::law::norm;
use super::{Law, Problem, residual_with};
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Diagonal entries of R below this fraction of the largest count as zero.
const CUT: f64 = 1e-11;

/// At most `most` Newton steps from p. Returns the best impulses, their residual, and the number of steps.
pub(super) fn polish(
    problem: &Problem,
    scales: &[f64],
    mut p: DVector<f64>,
    tolerance: f64,
    most: usize,
) -> (DVector<f64>, f64, usize) {
    let (mut best, mut least) = (p.clone(), residual_with(problem, scales, &p));
    for done in 0..most {
        if least <= tolerance {
            return (best, least, done);
        }
        let Some(step) = step(problem, scales, &p) else { return (best, least, done) };
        p += step;
        for (first, law) in problem.blocks() {
            law.project(&mut p.as_mut_slice()[first..first + law.rows()]);
        }
        let residual = residual_with(problem, scales, &p);
        if residual < least {
            (best, least) = (p.clone(), residual);
        } else if !residual.is_finite() {
            return (best, least, done + 1);
        }
    }
    (best, least, most)
}

/// x with F + F'x = 0. Rows at their bounds give their x at once, gx = −F; a system of the others remains.
fn step(problem: &Problem, scales: &[f64], p: &DVector<f64>) -> Option<DVector<f64>> {
    let Linear { F, free, A } = linearized(problem, scales, p);
    let mut x = DVector::from_iterator(F.len(), F.iter().zip(scales).map(|(F, g)| -F / g));
    free.iter().for_each(|&r| x[r] = 0.0);
    let right = -(F.select_rows(&free) + A.tr_mul(&x));
    let (one, count) = alike(problem, &free);
    let (mut B, mut b) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (j, &(column, weight)) in one.iter().enumerate() {
        b[column] += weight * right[j];
        for (i, &(row, other)) in one.iter().enumerate() {
            B[(row, column)] += weight * other * A[(free[j], i)];
        }
    }
    let found = least_squares(B, b)?;
    one.iter().zip(&free).for_each(|(&(k, weight), &r)| x[r] = weight * found[k]);
    Some(x)
}

/// Makes free rows that are the same up to a sign, such as the dry friction of a joint that is at its stop, one row of
/// unit length: the row that each becomes part of and its weight there, and their number. The least squares stay what
/// they are, and are often regular then.
fn alike(problem: &Problem, free: &[usize]) -> (Vec<(usize, f64)>, usize) {
    let G = &problem.G;
    let mut is_single = vec![false; problem.b.len()];
    problem.blocks().for_each(|(first, law)| is_single[first] = law.rows() == 1);
    // the first free row of each, and the number of its rows
    let mut groups: Vec<(usize, usize)> = Vec::with_capacity(free.len());
    let mut one = Vec::with_capacity(free.len());
    for &r in free {
        // rows of J are parallel if |G_rq|² = G_rr G_qq
        let g = G[(r, r)];
        let is_like = |q: usize| is_single[q] && G[(q, r)].abs() == g && G[(q, q)] == g;
        let like = if is_single[r] { groups.iter().position(|&(q, _)| is_like(q)) } else { None };
        let k = like.unwrap_or(groups.len());
        if like.is_none() {
            groups.push((r, 0));
        }
        groups[k].1 += 1;
        one.push((k, G[(groups[k].0, r)].signum()));
    }
    one.iter_mut().for_each(|(k, weight)| *weight /= Scalar::sqrt(groups[*k].1 as f64));
    (one, groups.len())
}

/// F(p) and its generalized derivative, in velocities: rows are u for active laws, g(p − Π(p − u/g)) for others. The
/// radius of a contact's disc is μ times its normal argument, so that De Saxcé's term is not needed.
struct Linear {
    F: DVector<f64>,
    /// The rows that are not at their bounds, where F' is more than g on the diagonal.
    free: Vec<usize>,
    /// Their F', a column each.
    A: DMatrix<f64>,
}

fn linearized(problem: &Problem, scales: &[f64], p: &DVector<f64>) -> Linear {
    let (G, u, m) = (&problem.G, problem.velocity(p), p.len());
    let (mut F, mut free, mut A) = (DVector::zeros(m), Vec::with_capacity(m), Vec::with_capacity(m * m));
    for (i, law) in problem.blocks() {
        let g = scales[i];
        let argument = |r: usize| p[r] - u[r] / g;
        let mut velocity = |r: usize| {
            F[r] = u[r];
            free.push(r);
            A.extend_from_slice(&G.as_slice()[r * m..][..m]); // symmetric
        };
        let Law::Contact { mu } = law else {
            let mut x = [argument(i)];
            law.project(&mut x);
            if x[0] == argument(i) && (law == Law::Bilateral || !is_at_bound(law, x[0])) {
                velocity(i);
            } else {
                F[i] = g * (p[i] - x[0]);
            }
            continue;
        };
        let x_n = argument(i);
        if x_n <= 0.0 {
            (i..i + 3).for_each(|r| F[r] = g * p[r]);
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
        let d = [x_1 / size, x_2 / size];
        for k in 0..2 {
            let row = i + 1 + k;
            F[row] = g * (p[row] - radius * d[k]);
            free.push(row);
            // ∂x/∂p = 1 − G/g
            A.extend((0..m).map(|c| {
                let dx = |r: usize| f64::from(u8::from(r == c)) - G[(r, c)] / g;
                let (dx_n, dx_1, dx_2) = (dx(i), dx(i + 1), dx(i + 2));
                let along = d[0] * dx_1 + d[1] * dx_2;
                let across = [dx_1, dx_2][k] - along * d[k];
                let change = -g * (mu * d[k] * dx_n + radius / size * across);
                if c == row { change + g } else { change }
            }));
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

/// The x of Ax = b by LU, if A is square and not close to singular. Its rows and columns are scaled first, to a
/// diagonal of ±1: the inertia at one joint may be many powers of ten that at another.
fn regular(A: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    if !A.is_square() || A.diagonal().iter().any(|x| *x == 0.0) {
        return None;
    }
    let scale = A.diagonal().map(|x| 1.0 / Scalar::sqrt(x.abs()));
    let lu = DMatrix::from_fn(A.nrows(), A.ncols(), |r, c| A[(r, c)] * (scale[r] * scale[c])).lu();
    let pivots = lu.lu_internal().diagonal().abs();
    if pivots.min() <= 1e-7 * pivots.max() {
        return None;
    }
    Some(lu.solve(&b.component_mul(&scale))?.component_mul(&scale))
}

/// The x of least norm that minimizes ‖Ax − b‖: by LU if A is [`regular`], else by QR with column pivoting,
/// A P = Q₁R₁, and a second QR of R₁ᵀ. (nalgebra's singular values lose digits on singular matrices.)
pub(crate) fn least_squares(A: DMatrix<f64>, b: DVector<f64>) -> Option<DVector<f64>> {
    if !A.as_slice().iter().chain(b.as_slice()).all(|x| x.is_finite()) {
        return None;
    }
    if let Some(x) = regular(&A, &b) {
        return Some(x);
    }
    let columns = A.ncols();
    let qr = A.col_piv_qr();
    let R = qr.r();
    let first = R.get((0, 0)).map_or(0.0, |x| x.abs());
    let rank = (0..R.nrows()).take_while(|&k| R[(k, k)].abs() > CUT * first).count();
    let mut x = DVector::zeros(columns);
    if rank == 0 {
        return Some(x);
    }
    let mut c = b;
    qr.q_tr_mul(&mut c);
    let second = R.rows(0, rank).transpose().qr();
    let c = second.r().tr_solve_upper_triangular(&c.rows(0, rank).into_owned())?;
    x.copy_from(&(second.q() * c));
    qr.p().inv_permute_rows(&mut x);
    Some(x)
}
