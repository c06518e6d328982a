//! The Delassus matrix A M⁻¹Aᵀ, and the multipliers that solve with it.
//!
//! With M = LᵀDL and Y = A L⁻¹ it is G = Y D⁻¹Yᵀ; a row of Y has the zeros of the tree. Constraints may be redundant, so
//! that G is singular: the multipliers are found by a proximal iteration,
//!
//! > λ₀ = 0,  λ ← λ + (G + ρ1)⁻¹(b − Gλ),  three times,
//!
//! which needs no decision about the rank and so works on registers, dual numbers and recordings. Its error in the
//! direction of an eigenvalue σ of G is (ρ/(σ + ρ))³ (Carpentier, Budhiraja and Mansard 2021).

use crate::dynamics::composite_inertias;
use crate::linalg::ldlt;
use crate::model::{Model, Workspace};
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;

/// How often the residual is solved for.
const REFINEMENTS: usize = 3;

/// Memory of the constrained dynamics, m constraint rows and n velocities.
#[derive(Clone, Debug)]
pub struct ConstraintMemory<S = f64> {
    /// A, m × n by rows.
    pub A: Vec<S>,
    /// Ȧθ̇, m.
    pub dA_dtheta: Vec<S>,
    /// L and D of M.
    pub(crate) M: Vec<S>,
    /// Y = A L⁻¹, m × n.
    pub(crate) Y: Vec<S>,
    /// G, m × m, its lower triangle.
    G: Vec<S>,
    /// The factors of G + ρ1.
    factors: Vec<S>,
    pivots: Vec<S>,
    /// b − Gλ.
    residual: Vec<S>,
    /// m and n numbers.
    pub(crate) right: Vec<S>,
    pub(crate) lambda: Vec<S>,
    pub(crate) vector: Vec<S>,
}

impl<S: Scalar> ConstraintMemory<S> {
    /// Memory for this model.
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let (m, n, o) = (model.constraint_rows(), model.n(), S::zero());
        ConstraintMemory {
            A: vec![o; m * n],
            dA_dtheta: vec![o; m],
            M: vec![o; n * n],
            Y: vec![o; m * n],
            G: vec![o; m * m],
            factors: vec![o; m * m],
            pivots: vec![o; m],
            residual: vec![o; m],
            right: vec![o; m],
            lambda: vec![o; m],
            vector: vec![o; n],
        }
    }

    /// Sets every number to NaN.
    pub(crate) fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        let ConstraintMemory { A, dA_dtheta, M, Y, G, factors, pivots, residual, right, lambda, vector } = self;
        for list in [A, dA_dtheta, M, Y, G, factors, pivots, residual, right, lambda, vector] {
            list.fill(nan);
        }
    }
}

/// Factors M(θ), which the memory then holds as L and D, and G + ρ1. The workspace holds T_{i,i−1}(θ), the memory A.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn factor<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &mut Workspace<S>,
    memory: &mut ConstraintMemory<S>,
) {
    let (m, n, pattern) = (model.ties.rows, model.n(), &model.structure.pattern);
    let ConstraintMemory { A, M, Y, G, factors, pivots, vector, .. } = memory;
    composite_inertias(model, workspace, M);
    ldlt::factor(pattern, M, &mut workspace.pivots);
    Y.copy_from_slice(A);
    let scaled = &mut vector[..n];
    for tie in &model.ties.list {
        for r in tie.first..tie.first + tie.kind.rows() {
            let y = &mut Y[r * n..][..n];
            ldlt::solve_transposed(pattern, M, y, tie.support.iter().copied()); // Lᵀy = a
            for &j in &tie.support {
                scaled[j] = y[j] / M[j * n + j];
            }
            for s in 0..=r {
                let other = &Y[s * n..][..n];
                let mut sum = S::zero();
                for &j in &tie.support {
                    sum = scaled[j].mul_add(other[j], sum);
                }
                G[r * m + s] = sum;
            }
        }
    }
    let mut trace = S::from_f64(1e-30); // no row can move: 0/ρ stays 0
    for r in 0..m {
        trace += G[r * m + r];
    }
    let rho = trace * S::from_f64(relative_rho::<S>() / m.max(1) as f64);
    factors.copy_from_slice(G);
    for r in 0..m {
        factors[r * m + r] += rho;
    }
    ldlt::factor(&model.ties.dense, factors, pivots);
}

/// ρ over the mean diagonal entry of G: 10⁻¹⁰ for `f64`, 3 · 10⁻⁵ for `f32`.
fn relative_rho<S: Scalar>() -> f64 {
    let half: f64 = 0.5;
    (0..S::DIGITS * 5 / 8).fold(1.0, |x, _| x * half)
}

/// Solves Gλ = b, with b in the memory's `right` and λ in its `lambda`.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn solve<S: Scalar, C: Scalar>(model: &Model<C>, memory: &mut ConstraintMemory<S>) {
    let m = model.ties.rows;
    let ConstraintMemory { G, factors, residual, right, lambda, .. } = memory;
    lambda.copy_from_slice(right);
    ldlt::solve(&model.ties.dense, factors, lambda);
    for _ in 1..REFINEMENTS {
        for r in 0..m {
            let mut sum = right[r];
            for s in 0..m {
                let g = G[r.max(s) * m + r.min(s)];
                sum = g.mul_add(-lambda[s], sum);
            }
            residual[r] = sum;
        }
        ldlt::solve(&model.ties.dense, factors, residual);
        for r in 0..m {
            lambda[r] += residual[r];
        }
    }
}

/// x ← x − D⁻¹Yᵀλ, which L⁻¹ makes the change of an acceleration or a velocity by −Aᵀλ.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn subtract_forces<S: Scalar, C: Scalar>(model: &Model<C>, memory: &ConstraintMemory<S>, x: &mut [S]) {
    let n = model.n();
    for tie in &model.ties.list {
        for r in tie.first..tie.first + tie.kind.rows() {
            let y = &memory.Y[r * n..][..n];
            for &j in &tie.support {
                x[j] = y[j].mul_add(-memory.lambda[r], x[j]);
            }
        }
    }
}

/// b_r = Σ_j Y_rj x_j, added to what `right` holds.
#[cfg_attr(not(test), inline(always))]
pub(crate) fn add_products<S: Scalar, C: Scalar>(model: &Model<C>, rows: &[S], x: &[S], right: &mut [S]) {
    let n = model.n();
    for tie in &model.ties.list {
        for r in tie.first..tie.first + tie.kind.rows() {
            let row = &rows[r * n..][..n];
            for &j in &tie.support {
                right[r] = row[j].mul_add(x[j], right[r]);
            }
        }
    }
}
