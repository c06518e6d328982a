//! The Delassus matrix A M⁻¹Aᵀ, and the solution for the multipliers.
//!
//! With M = LᵀDL and Y = A L⁻¹, it is G = Y D⁻¹Yᵀ; a row of Y has the sparsity of the tree. Constraints may be
//! redundant, so that G is singular: the multipliers are found by a proximal iteration,
//!
//! > λ₀ = 0,  λ ← λ + (G + R)⁻¹(b − Gλ),  three times,  R = diag ρ,
//!
//! which needs no decision about the rank and so works on dual numbers and recordings. Its error in the
//! direction of an eigenvalue σ of R^(−½) G R^(−½) is (1/(σ + 1))³ (Carpentier, Budhiraja and Mansard 2021, with one
//! ρ).
//! After a step by δ, the residual b − Gλ is Rδ.
//!
//! ρ is relative to the size of the row's own constraint, so that a cam of 10⁶ rad/rad and a rod of 1 m can belong to
//! one robot; within a constraint, rows that hardly move are those that the others make redundant. A thin rod turns
//! about its axis much more easily than its ends move: next to these, angular rows count little.

use crate::dynamics::{composite_inertias, fill_mass_matrix};
use crate::linalg::{dense_ldlt, ldlt};
use crate::model::{Model, Tie};
use crate::scalar::{Scalar, pass};
use crate::workspace::{ConstraintMemory, MOST_ROWS, Workspace};

/// The number of proximal iterations.
const STEPS: usize = 3;

pass! {
/// Factors M(θ) into L and D, and G + diag ρ; the memory holds both afterwards. Requires T_{i,i−1}(θ) in the workspace
/// and A in the memory.
pub fn factor<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &mut Workspace<S>,
    memory: &mut ConstraintMemory<S>,
) {
    let (m, n) = (model.ties.rows, model.n());
    composite_inertias(model, workspace);
    fill_mass_matrix(model, workspace, &mut memory.M);
    ldlt::factor(&model.structure.pattern, &mut memory.M, &mut workspace.pivots);
    for j in 0..n {
        memory.vector[j] = S::one() / memory.M[j * n + j];
    }
    memory.Y.copy_from_slice(&memory.A);
    for tie in &model.ties.list {
        match tie.kind.rows() {
            1 => add_rows::<1, S, C>(model, tie, memory),
            3 => add_rows::<3, S, C>(model, tie, memory),
            5 => add_rows::<5, S, C>(model, tie, memory),
            _ => add_rows::<MOST_ROWS, S, C>(model, tie, memory),
        }
    }
    let ConstraintMemory { G, one_over_d, rho, .. } = memory;
    let mut trace = S::from_f64(1e-30); // keeps ρ positive if no row can move: 0/ρ stays 0
    for r in 0..m {
        trace += G[r * m + r];
    }
    let relative = power_of_epsilon::<S>(5, 8);
    let least = trace * S::from_f64(relative * relative / m.max(1) as f64); // rows of rounding errors
    for tie in &model.ties.list {
        let (linear, end) = (tie.first + tie.kind.angular_rows(), tie.first + tie.kind.rows());
        let sum = |rows: core::ops::Range<usize>| rows.fold(S::zero(), |sum, r| sum + G[r * m + r]);
        let (turns, moves) = (sum(tie.first..linear), sum(linear..end));
        let weight = S::from_f64(relative / tie.kind.rows() as f64);
        let of_turns = (turns + moves).mul_add(weight, least);
        let of_moves = turns.mul_add(S::from_f64(power_of_epsilon::<S>(1, 4)), moves).mul_add(weight, least);
        for r in tie.first..end {
            rho[r] = if r < linear { of_turns } else { of_moves };
            G[r * m + r] += rho[r];
        }
    }
    dense_ldlt::factor(G, one_over_d);
}
}

/// Computes R rows of Y, LᵀY = Aᵀ, and of G's upper triangle. The rows are interleaved because each number of a row
/// depends on the one before it. `vector` holds 1/D.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_rows<const R: usize, S: Scalar, C: Scalar>(model: &Model<C>, tie: &Tie<C>, memory: &mut ConstraintMemory<S>) {
    let (m, n, pattern) = (model.ties.rows, model.n(), &model.structure.pattern);
    let ConstraintMemory { M, Y, scaled, G, vector, .. } = memory;
    let (Y_tie, scaled) = (&mut Y[tie.first * n..][..R * n], &mut scaled[..R * n]);
    for &k in &tie.support {
        let L = &M[k * n..][..n];
        let mut y = [S::zero(); R];
        for r in 0..R {
            y[r] = Y_tie[r * n + k];
            scaled[r * n + k] = y[r] * vector[k];
        }
        for i in pattern.ancestors(k) {
            for r in 0..R {
                Y_tie[r * n + i] = L[i].mul_add(-y[r], Y_tie[r * n + i]);
            }
        }
    }
    let mut rows = [&scaled[..n]; R];
    for r in 1..R {
        rows[r] = &scaled[r * n..][..n];
    }
    for other in &model.ties.list {
        if other.first > tie.first {
            break;
        }
        let columns = shared(&tie.support, &other.support);
        for s in other.first..other.first + other.kind.rows() {
            let row = &Y[s * n..][..n];
            let mut sums = [S::zero(); R];
            for &j in columns {
                for r in 0..R {
                    sums[r] = rows[r][j].mul_add(row[j], sums[r]);
                }
            }
            for r in 0..R {
                G[s * m + tie.first + r] = sums[r];
            }
        }
    }
}

/// The columns of the first list that may also be in the second; both lists are descending.
#[cfg_attr(not(debug_assertions), inline(always))]
fn shared<'s>(columns: &'s [usize], others: &[usize]) -> &'s [usize] {
    let (mut from, last) = (0, others.first().copied().unwrap_or_default());
    while from < columns.len() && columns[from] > last {
        from += 1;
    }
    &columns[from..]
}

/// ε to the power of a/b. ε^⅝ is ρ relative to the mean diagonal entry of a constraint's part of G, 10⁻¹⁰ for `f64`
/// and 3 · 10⁻⁵ for `f32`; ε^¼, 10⁻⁴ and 2 · 10⁻², the weight of angular rows next to linear ones.
fn power_of_epsilon<S: Scalar>(a: u32, b: u32) -> f64 {
    let half: f64 = 0.5;
    (0..S::DIGITS * a / b).fold(1.0, |x, _| x * half)
}

/// Solves Gλ = b, with b in the memory's `right` and λ in its `lambda`.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn solve<S: Scalar, C: Scalar>(model: &Model<C>, memory: &mut ConstraintMemory<S>) {
    let m = model.ties.rows;
    let ConstraintMemory { G, one_over_d, rho, step, right, lambda, .. } = memory;
    step.copy_from_slice(right);
    dense_ldlt::solve(G, one_over_d, step);
    lambda.copy_from_slice(step);
    for _ in 1..STEPS {
        for r in 0..m {
            step[r] = step[r] * rho[r];
        }
        dense_ldlt::solve(G, one_over_d, step);
        for r in 0..m {
            lambda[r] += step[r];
        }
    }
}

/// x ← x − Yᵀλ, which D⁻¹ and then L⁻¹ turn into the change of an acceleration or a velocity by −Aᵀλ.
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// Adds b_r = Σ_j Y_rj x_j to `right`.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn add_products<S: Scalar, C: Scalar>(model: &Model<C>, rows: &[S], x: &[S], right: &mut [S]) {
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
