//! The projection of forces onto those that move the robot (Modern Robotics, section 8.7).

use super::delassus::{factor, solve};
use super::jacobian::constraint_jacobian;
use crate::linalg::ldlt;
use crate::model::Model;
use crate::quantities::{Call, Declaration, Kernel, MATRIX, Memory, Quantity, THETA, output};
use crate::scalar::Scalar;
use crate::workspace::{ConstraintMemory, Workspace};

/// P(θ) = 1 − Aᵀ(A M⁻¹Aᵀ)⁻¹A M⁻¹, n × n by rows: Pτ = P(Mθ̈ + h) are the equations of motion without λ. Rank n − rank
/// A.
///
/// Cost O(n · m · (n + m)), no allocation.
///
/// # Panics
/// When θ is not nq long, or P not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn constraint_projection<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    memory: &mut ConstraintMemory<S>,
    P: &mut [S],
) {
    let (m, n) = (model.constraint_rows(), model.n());
    assert!(P.len() == n * n, "P has {} entries, expected n² = {}", P.len(), n * n);
    constraint_jacobian(model, theta, dtheta, workspace, &mut memory.A, &mut [], &mut []);
    factor(model, workspace, memory);
    // Y ← A M⁻¹
    for r in 0..m {
        let row = &mut memory.Y[r * n..][..n];
        ldlt::solve_rest(&model.structure.pattern, &memory.M, row);
    }
    for c in 0..n {
        for r in 0..m {
            memory.right[r] = memory.Y[r * n + c];
        }
        solve(model, memory);
        for i in 0..n {
            let mut entry = if i == c { S::one() } else { S::zero() };
            for r in 0..m {
                entry = memory.A[r * n + i].mul_add(-memory.lambda[r], entry);
            }
            P[i * n + c] = entry;
        }
    }
}

/// See [`constraint_projection`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintProjection;
#[doc(hidden)]
impl Quantity for ConstraintProjection {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_projection",
        "P(θ) = 1 − Aᵀ(A M⁻¹Aᵀ)⁻¹A M⁻¹: Pτ = P(Mθ̈ + h)",
        &[THETA],
        &[output("P", MATRIX, "1, m or 1/m")],
    )
    .is_constrained()
    .at_rest()
    .divides();
}
#[doc(hidden)]
impl Kernel for ConstraintProjection {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [P, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, constraints, .. } = c.memory;
        let memory = constraints.get_or_insert_with(|| ConstraintMemory::new(c.model));
        constraint_projection(c.model, theta, dtheta, workspace, memory, P);
    }
}
