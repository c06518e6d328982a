//! Forward dynamics of robots with constraints (Modern Robotics, section 8.7).

use super::delassus::{add_products, factor, solve, subtract_forces};
use super::jacobian::rows;
use crate::dynamics::{add_spring_forces, bias_forces, joint_friction};
use crate::linalg::ldlt;
use crate::model::{Environment, Model};
use crate::quantities::{
    ACCELERATION, Call, DTHETA, Declaration, Dim, Kernel, Memory, Quantity, TAU, THETA, Uses, VECTOR, output,
};
use crate::scalar::Scalar;
use crate::workspace::{ConstraintMemory, Workspace};

/// θ̈ and λ of a robot with constraints:
///
/// > τ = M θ̈ + h + f + Aᵀλ,  A θ̈ + Ȧθ̇ = 0,  so (A M⁻¹Aᵀ)λ = A M⁻¹(τ − h − f) + Ȧθ̇
///
/// with h in this environment and f friction and springs. λ, m numbers, are the forces and moments that the robot
/// applies through its constraints; N and N m. θ and θ̇ are assumed to satisfy the constraints: see
/// [`constraint_impulse`]. Without constraints this is forward dynamics by the mass matrix.
///
/// Cost O(n · depth² + m · depth² + m³), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or θ̈ not n, or λ not m.
///
/// [`constraint_impulse`]: crate::constraints::constraint_impulse
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // forward_dynamics' seven, memory, and λ
pub fn constrained_forward_dynamics<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    memory: &mut ConstraintMemory<S>,
    ddtheta: &mut [S],
    lambda: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    let (n, pattern) = (model.n(), &model.structure.pattern);
    bias_forces(model, theta, dtheta, environment, workspace, ddtheta); // leaves T_{i,i−1} for the rows
    add_spring_forces(model, theta, ddtheta);
    for j in 0..n {
        ddtheta[j] = tau[j] - ddtheta[j] - joint_friction(model, j, dtheta[j]);
    }
    rows(model, theta, dtheta, workspace, &mut memory.A, &mut memory.dA_dtheta, &mut []);
    factor(model, workspace, memory);

    // w = L⁻ᵀ(τ − h − f), b = Y D⁻¹w + Ȧθ̇, θ̈ = L⁻¹D⁻¹(w − Yᵀλ)
    ldlt::solve_transposed_all(pattern, &memory.M, ddtheta);
    for j in 0..n {
        memory.vector[j] = ddtheta[j] * memory.vector[j]; // which held 1/D
    }
    memory.right.copy_from_slice(&memory.dA_dtheta);
    add_products(model, &memory.Y, &memory.vector, &mut memory.right);
    solve(model, memory);
    subtract_forces(model, memory, ddtheta);
    ldlt::solve_rest(pattern, &memory.M, ddtheta);
    lambda.copy_from_slice(&memory.lambda);
}

/// See [`constrained_forward_dynamics`].
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedForwardDynamics;
impl Quantity for ConstrainedForwardDynamics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "constrained_forward_dynamics",
        "θ̈ and λ of τ = Mθ̈ + c + g + JᵀF + f + Aᵀλ with Aθ̈ + Ȧθ̇ = 0",
        &[THETA, DTHETA, TAU],
        &[output("ddtheta", VECTOR, ACCELERATION), output("multipliers", &[Dim::Constraints], "N m or N")],
    )
    .uses(Uses::ALL)
    .is_constrained()
    .divides();
}
impl Kernel for ConstrainedForwardDynamics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, lambda, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, constraints, .. } = c.memory;
        let memory = constraints.get_or_insert_with(|| ConstraintMemory::new(c.model));
        constrained_forward_dynamics(c.model, theta, dtheta, tau, c.environment, workspace, memory, ddtheta, lambda);
    }
}
