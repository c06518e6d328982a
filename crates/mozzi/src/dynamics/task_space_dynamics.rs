//! Dynamics in the task space (Modern Robotics, section 8.6; for redundant robots Khatib 1987).

use super::bias_forces::bias_forces;
use super::mass_matrix::mass_matrix;
use crate::kinematics::{body_jacobian, body_jacobian_rate, space_jacobian, space_jacobian_rate, twist_of};
use crate::linalg::ldlt::{self, Pattern};
use crate::model::{Environment, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::Twist;
use crate::task_space::{Task, TaskFrame};
use alloc::vec;
use alloc::vec::Vec;

/// Memory of [`task_space_dynamics`] for k rows, and what it finds on its way.
#[derive(Clone, Debug)]
pub struct TaskMemory<S = f64> {
    /// J, k × n by rows.
    pub J: Vec<S>,
    /// J̇θ̇, k.
    pub dJ_dtheta: Vec<S>,
    /// What Λ⁻¹ divided by: where one is not above rounding of the others, the task is singular. Those of M are the workspace's.
    pub pivots: Vec<S>,
    /// Λ⁻¹ has no zeros to use.
    dense: Pattern,
    M: Vec<S>,
    /// M⁻¹h.
    h: Vec<S>,
    /// A row of J M⁻¹.
    row: Vec<S>,
    columns: Vec<Twist<S>>,
}

impl<S: Scalar> TaskMemory<S> {
    /// For a task of this many rows.
    pub fn new<C: Scalar>(model: &Model<C>, rows: usize) -> Self {
        let (n, o) = (model.n(), S::zero());
        TaskMemory {
            J: vec![o; rows * n],
            dJ_dtheta: vec![o; rows],
            pivots: vec![o; rows],
            dense: Pattern::new(rows, rows, core::iter::empty()),
            M: vec![o; n * n],
            h: vec![o; n],
            row: vec![o; n.max(rows)],
            columns: vec![Twist::zero(); n],
        }
    }
}

/// Λ = (J M⁻¹Jᵀ)⁻¹, k × k, and η = Λ(J M⁻¹h − J̇θ̇), k, of the k rows of a task: 𝓕 = Λ𝒱̇ + η. h as
/// [`bias_forces`] in this environment, without friction.
///
/// Cost O(n · depth · (depth + k)), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, Λ not k², η not k, or a row above 5.
#[cfg_attr(not(test), inline(always))]
#[allow(clippy::too_many_arguments)] // a state, a task, memory, and two results
pub fn task_space_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    task: Task,
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    memory: &mut TaskMemory<S>,
    Lambda: &mut [S],
    eta: &mut [S],
) {
    let (n, k, pattern) = (model.n(), task.rows.len(), &model.structure.pattern);
    assert!(
        Lambda.len() == k * k && eta.len() == k,
        "Lambda and eta have {} and {} entries, expected k² and k for {k} rows",
        Lambda.len(),
        eta.len()
    );
    let TaskMemory { J, dJ_dtheta, pivots, dense, M, h, row, columns } = memory;
    bias_forces(model, theta, dtheta, environment, workspace, h);
    match task.coordinates {
        TaskFrame::Body => body_jacobian_rate(model, theta, dtheta, task.frame, columns),
        TaskFrame::Space => space_jacobian_rate(model, theta, dtheta, task.frame, workspace, columns),
    }
    let acceleration = twist_of(columns, dtheta).to_array();
    match task.coordinates {
        TaskFrame::Body => body_jacobian(model, theta, task.frame, columns),
        TaskFrame::Space => space_jacobian(model, theta, task.frame, columns),
    }
    for (r, &component) in task.rows.iter().enumerate() {
        dJ_dtheta[r] = acceleration[component];
        for (j, column) in columns.iter().enumerate() {
            J[r * n + j] = column.to_array()[component];
        }
    }

    mass_matrix(model, theta, workspace, M);
    ldlt::factor(pattern, M);
    ldlt::solve(pattern, M, h);
    for (j, pivot) in workspace.pivots.iter_mut().enumerate() {
        *pivot = M[j * n + j];
    }
    let dot = |a: &[S], b: &[S]| a.iter().zip(b).fold(S::zero(), |sum, (&a, &b)| a.mul_add(b, sum));
    for r in 0..k {
        eta[r] = dot(&J[r * n..][..n], h) - dJ_dtheta[r];
        row[..n].copy_from_slice(&J[r * n..][..n]);
        ldlt::solve(pattern, M, &mut row[..n]);
        for c in 0..=r {
            Lambda[r * k + c] = dot(&J[c * n..][..n], &row[..n]); // Λ⁻¹ = J M⁻¹Jᵀ
        }
    }
    ldlt::factor(dense, Lambda);
    for (r, pivot) in pivots.iter_mut().enumerate() {
        *pivot = Lambda[r * k + r];
    }
    ldlt::solve(dense, Lambda, eta);
    ldlt::invert(dense, Lambda, &mut row[..k]);
}
