//! Dynamics in the task space (Modern Robotics, section 8.6; for redundant robots Khatib 1987).

use super::bias_forces::bias_forces;
use super::mass_matrix::mass_matrix;
use crate::kinematics::{body_jacobian, body_jacobian_rate, space_jacobian, space_jacobian_rate, twist_of};
use crate::linalg::ldlt;
use crate::model::{Environment, Model, Task, TaskFrame, TaskMemory};
use crate::quantities::{Call, DTHETA, Declaration, Dim, Kernel, Memory, Of, Quantity, THETA, Uses, output, symmetric};
use crate::scalar::{Scalar, pass};
use crate::workspace::Workspace;

pass! {
/// Λ = (J M⁻¹Jᵀ)⁻¹, k × k, and η = Λ(J M⁻¹h − J̇θ̇), k, of the k rows of a task: 𝓕 = Λ𝒱̇ + η. h as
/// [`bias_forces`] in this environment, without friction and springs.
///
/// Cost O(n · depth · (depth + k)), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, Λ not k², η not k, or a row above 5.
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
    let TaskMemory { J, dJ_dtheta, pivots, dense, M, h, Q, row, columns } = memory;
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
    ldlt::factor(pattern, M, &mut workspace.pivots);
    ldlt::solve(pattern, M, h);
    for r in 0..k {
        let (J, Q) = (&J[r * n..][..n], &mut Q[r * n..][..n]);
        eta[r] = dot(J, h) - dJ_dtheta[r];
        Q.copy_from_slice(J);
        ldlt::solve_transposed_all(pattern, M, Q);
    }
    factor_rows(Q, &workspace.pivots, &mut row[..n], Lambda, &mut pivots[..k]);
    pivots[k] = S::zero();
    for (column, &d) in columns.iter().zip(&workspace.pivots) {
        pivots[k] += dot(&column.to_array(), &column.to_array()) / d;
    }
    ldlt::solve(dense, Lambda, eta);
    ldlt::invert(dense, Lambda, &mut row[..k]);
}
}

/// Overwrites the lower triangle of Λ with L and D', where LᵀD'L = Q D⁻¹Qᵀ, by Gram and Schmidt's orthogonalisation of
/// the rows of Q. The product itself would square their condition number.
#[cfg_attr(not(debug_assertions), inline(always))]
fn factor_rows<S: Scalar>(Q: &mut [S], D: &[S], scaled: &mut [S], Lambda: &mut [S], pivots: &mut [S]) {
    let (n, k) = (scaled.len(), pivots.len());
    for r in (0..k).rev() {
        let (above, q) = Q.split_at_mut(r * n);
        let q = &q[..n];
        for ((scaled, &q), &d) in scaled.iter_mut().zip(q).zip(D) {
            *scaled = q / d;
        }
        let d = dot(q, scaled);
        (pivots[r], Lambda[r * k + r]) = (d, d);
        for s in 0..r {
            let other = &mut above[s * n..][..n];
            let l = dot(other, scaled) / d;
            for (x, &q) in other.iter_mut().zip(q) {
                *x = q.mul_add(-l, *x);
            }
            Lambda[r * k + s] = l;
        }
    }
}

/// aᵀb.
#[cfg_attr(not(debug_assertions), inline(always))]
fn dot<S: Scalar>(a: &[S], b: &[S]) -> S {
    let mut sum = S::zero();
    for (&a, &b) in a.iter().zip(b) {
        sum = a.mul_add(b, sum);
    }
    sum
}

/// See [`task_space_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct TaskSpaceDynamics;
#[doc(hidden)]
impl Quantity for TaskSpaceDynamics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "task_space_dynamics",
        "Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as the rows of a frame's twist show them",
        &[THETA, DTHETA],
        &[symmetric("Lambda", &[Dim::Rows, Dim::Rows], "kg m², kg m, kg"), output("eta", &[Dim::Rows], "N m, N")],
    )
    .of(Of::Task)
    .uses(Uses::ALL)
    .divides();
}
#[doc(hidden)]
impl Kernel for TaskSpaceDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [Lambda, eta, ..], task) = (c.inputs, c.outputs, c.of.task());
        let Memory { workspace, tasks, .. } = c.memory;
        let own = tasks.iter().position(|memory| memory.rows() == task.rows.len()).unwrap_or_else(|| {
            tasks.push(TaskMemory::new(c.model, task.rows.len()));
            tasks.len() - 1
        });
        tasks.swap(0, own);
        task_space_dynamics(c.model, theta, dtheta, task, c.environment, workspace, &mut tasks[0], Lambda, eta);
    }
}
