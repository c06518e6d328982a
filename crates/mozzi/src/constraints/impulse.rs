//! The impulse of constraints that begin to act suddenly (Modern Robotics, section 8.7).

use super::delassus::{add_products, factor, solve, subtract_forces};
use super::jacobian::constraint_jacobian;
use crate::linalg::ldlt;
use crate::model::Model;
use crate::quantities::{Call, DTHETA, Declaration, Dim, Kernel, Memory, Quantity, THETA, VECTOR, output};
use crate::scalar::Scalar;
use crate::workspace::{ConstraintMemory, Workspace};

/// The velocities θ̇⁺ after the constraints have begun to act, and their impulse Λ, m numbers, N s and N m s:
///
/// > M(θ̇⁺ − θ̇) = −AᵀΛ,  A θ̇⁺ = 0,  so (A M⁻¹Aᵀ)Λ = A θ̇
///
/// θ̇⁺ is the velocity that satisfies the constraints nearest to θ̇ in the metric of M. The impact is inelastic:
/// kinetic energy is lost.
///
/// Cost O(n · depth² + m · depth² + m³), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ or θ̇⁺ not n, or Λ not m.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn constraint_impulse<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    memory: &mut ConstraintMemory<S>,
    dtheta_after: &mut [S],
    impulse: &mut [S],
) {
    constraint_jacobian(model, theta, dtheta, workspace, &mut memory.A, &mut [], &mut []);
    factor(model, workspace, memory);
    memory.right.fill(S::zero());
    add_products(model, &memory.A, dtheta, &mut memory.right);
    change(model, memory, dtheta_after);
    for (after, &before) in dtheta_after.iter_mut().zip(dtheta) {
        *after += before;
    }
    impulse.copy_from_slice(&memory.lambda);
}

/// −M⁻¹Aᵀλ, where λ solves A M⁻¹Aᵀλ = b and b is `memory.right`.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn change<S: Scalar, C: Scalar>(model: &Model<C>, memory: &mut ConstraintMemory<S>, x: &mut [S]) {
    solve(model, memory);
    x.fill(S::zero());
    subtract_forces(model, memory, x);
    ldlt::solve_rest(&model.structure.pattern, &memory.M, x);
}

/// See [`constraint_impulse`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintImpulse;
impl Quantity for ConstraintImpulse {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_impulse",
        "θ̇⁺ and Λ of M(θ̇⁺ − θ̇) = −AᵀΛ with Aθ̇⁺ = 0: the velocities after the constraints have begun to act",
        &[THETA, DTHETA],
        &[output("dtheta_after", VECTOR, DTHETA.unit), output("impulse", &[Dim::Constraints], "N m s or N s")],
    )
    .is_constrained()
    .divides();
}
impl Kernel for ConstraintImpulse {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [after, impulse, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, constraints, .. } = c.memory;
        let memory = constraints.get_or_insert_with(|| ConstraintMemory::new(c.model));
        constraint_impulse(c.model, theta, dtheta, workspace, memory, after, impulse);
    }
}
