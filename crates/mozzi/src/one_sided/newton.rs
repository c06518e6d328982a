//! Semi-smooth Newton steps on Alart and Curnier's function (1991), with least squares for the step because G may be
//! singular.

use super::law::norm;
use super::{Law, Problem, residual_with};
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
        let (F, A) = linearized(problem, scales, &p);
        let Some(step) = least_squares(A, -F) else { return (best, least, done) };
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

/// F(p) and its generalized derivative, in velocities: rows are u for active laws, g(p − Π(p − u/g)) for others. The
/// radius of a contact's disc is μ times its normal argument, so that De Saxcé's term is not needed.
fn linearized(problem: &Problem, scales: &[f64], p: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let (G, u, m) = (&problem.G, problem.velocity(p), p.len());
    let (mut F, mut A) = (DVector::zeros(m), DMatrix::zeros(m, m));
    let velocity = |r: usize, F: &mut DVector<f64>, A: &mut DMatrix<f64>| {
        F[r] = u[r];
        A.row_mut(r).copy_from(&G.row(r));
    };
    for (i, law) in problem.blocks() {
        let g = scales[i];
        let argument = |r: usize| p[r] - u[r] / g;
        let Law::Contact { mu } = law else {
            let mut x = [argument(i)];
            law.project(&mut x);
            if x[0] == argument(i) && (law == Law::Bilateral || !is_at_bound(law, x[0])) {
                velocity(i, &mut F, &mut A);
            } else {
                F[i] = g * (p[i] - x[0]);
                A[(i, i)] = g;
            }
            continue;
        };
        let x_n = argument(i);
        if x_n <= 0.0 {
            for r in i..i + 3 {
                F[r] = g * p[r];
                A[(r, r)] = g;
            }
            continue;
        }
        velocity(i, &mut F, &mut A);
        let (x_1, x_2) = (argument(i + 1), argument(i + 2));
        let (size, radius) = (norm(x_1, x_2), mu * x_n);
        if size <= radius {
            velocity(i + 1, &mut F, &mut A);
            velocity(i + 2, &mut F, &mut A);
            continue;
        }
        let d = [x_1 / size, x_2 / size];
        for k in 0..2 {
            F[i + 1 + k] = g * (p[i + 1 + k] - radius * d[k]);
        }
        // ∂x/∂p = 1 − G/g
        for c in 0..m {
            let dx = |r: usize| f64::from(u8::from(r == c)) - G[(r, c)] / g;
            let (dx_n, dx_1, dx_2) = (dx(i), dx(i + 1), dx(i + 2));
            let along = d[0] * dx_1 + d[1] * dx_2;
            let across = [dx_1 - along * d[0], dx_2 - along * d[1]];
            for k in 0..2 {
                A[(i + 1 + k, c)] = -g * (mu * d[k] * dx_n + radius / size * across[k]);
            }
        }
        A[(i + 1, i + 1)] += g;
        A[(i + 2, i + 2)] += g;
    }
    (F, A)
}

fn is_at_bound(law: Law, x: f64) -> bool {
    match law {
        Law::Stop => x <= 0.0,
        Law::Dry { most } => x.abs() >= most,
        _ => false,
    }
}

/// The x of least norm that minimizes ‖Ax − b‖: by LU if the pivots are far from zero, else by QR with column pivoting,
/// A P = Q₁R₁, and a second QR of R₁ᵀ. (nalgebra's singular values lose digits on singular matrices.)
pub(crate) fn least_squares(A: DMatrix<f64>, b: DVector<f64>) -> Option<DVector<f64>> {
    if !A.iter().chain(&b).all(|x| x.is_finite()) {
        return None;
    }
    if A.is_square() {
        let lu = A.clone().lu();
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for k in 0..A.nrows() {
            let x = lu.lu_internal()[(k, k)].abs();
            (low, high) = (low.min(x), high.max(x));
        }
        if low > 1e-7 * high {
            return lu.solve(&b);
        }
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
