//! ∂θ̈ of forward dynamics, from the derivatives of inverse dynamics and the factors of M (Carpentier and Mansard
//! 2018).

use super::armature::{add_velocity_product_rates, add_velocity_products};
use super::base_rates::BaseRates;
use super::bias_forces::take_zeros;
use super::composite_bodies::add_up_bodies;
use super::derivatives::{add_accelerations, add_damping, joint_forces, outward_pass};
use super::forward_dynamics::forward_dynamics;
use super::inverse_dynamics_derivatives::fill_derivatives;
use super::joint_friction::joint_friction;
use super::long_limbs;
use super::mass_matrix::fill_mass_matrix;
use super::spring_forces::{add_spring_forces, add_stiffness};
use crate::kinematics::joint_transforms;
use crate::linalg::{Square, ldlt};
use crate::model::{Environment, Model};
use crate::quantities::{
    ACCELERATION, Call, D_ACCELERATION, DTHETA, Declaration, Kernel, MATRIX, Quantity, TAU, THETA, Uses, VECTOR,
    output, symmetric,
};
use crate::scalar::{Scalar, pass};
use crate::workspace::Workspace;

pass! {
/// θ̈ of [`forward_dynamics`](super::forward_dynamics()), and its derivatives `[∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹]`, each n
/// × n, row-major: row i is θ̈_i's, and columns are those of
/// [`InverseDynamicsDerivatives`](crate::quantities::InverseDynamicsDerivatives).
///
/// θ̈ is computed from M, which the derivatives need as well; for robots with long limbs by articulated bodies, whose
/// factors then give all columns without ∂τ. Inverse dynamics τ(θ, θ̇, θ̈(θ, θ̇, τ)) = τ, differentiated:
///
/// > ∂θ̈/∂θ = −M⁻¹ ∂τ/∂θ, ∂θ̈/∂θ̇ = −M⁻¹ ∂τ/∂θ̇, ∂θ̈/∂τ = M⁻¹, all at this θ̈
///
/// If M is singular, the results are infinite, NaN or meaningless: the methods of [`Model`] check the pivots and return
/// an error.
///
/// Cost O(n² · depth), for robots with long limbs O(n²), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇, τ or θ̈ not n, or a derivative not n².
pub fn forward_dynamics_derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], tau: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, ddtheta: &mut [S], matrices: [&mut [S]; 3],
) {
    let [d_theta, d_dtheta, d_tau] = matrices;
    let (n, pattern) = (model.n(), &model.structure.pattern);
    model.assert_lengths(theta.len(), [dtheta.len(), tau.len(), ddtheta.len()]);
    if S::IS_ONE && model.structure.has_long_limbs {
        forward_dynamics(model, theta, dtheta, tau, environment, workspace, ddtheta);
        long_limbs::derivatives(model, theta, dtheta, ddtheta, environment, workspace, [d_theta, d_dtheta, d_tau]);
        return;
    }
    joint_transforms(model, theta, workspace);
    let zero = take_zeros(workspace);
    outward_pass(model, theta, dtheta, &zero, environment, None, workspace);
    workspace.vector = zero;

    add_up_bodies::<true, S, C>(model, workspace);

    // M θ̈ = τ − h − f
    fill_mass_matrix(model, workspace, d_tau);
    joint_forces(model, workspace, ddtheta);
    add_velocity_products(model, dtheta, ddtheta);
    add_spring_forces(model, theta, ddtheta);
    for j in 0..n {
        ddtheta[j] = tau[j] - ddtheta[j] - joint_friction(model, j, dtheta[j]);
    }
    ldlt::factor(pattern, d_tau, &mut workspace.pivots);
    ldlt::solve(pattern, d_tau, ddtheta);

    add_accelerations(model, ddtheta, workspace);
    let base = BaseRates::of_derivatives(model, theta, environment, workspace);
    fill_derivatives(model, base, workspace, [Square::zero(n, d_theta), Square::zero(n, d_dtheta)]);
    add_damping(model, d_dtheta);
    add_stiffness(model, theta, d_theta);
    add_velocity_product_rates(model, dtheta, d_dtheta);
    ldlt::solve_rows(pattern, d_tau, [d_theta, d_dtheta]);
    ldlt::invert(pattern, d_tau, &mut workspace.vector);
}
}

/// See [`forward_dynamics_derivatives`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardDynamicsDerivatives;
impl Quantity for ForwardDynamicsDerivatives {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_dynamics_derivatives",
        "θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, row i of θ̈_i; by θ along the velocities",
        &[THETA, DTHETA, TAU],
        &[
            output("ddtheta", VECTOR, ACCELERATION),
            output("d_theta", MATRIX, D_ACCELERATION),
            output("d_dtheta", MATRIX, D_ACCELERATION),
            symmetric("d_tau", MATRIX, D_ACCELERATION),
        ],
    )
    .uses(Uses::ALL)
    .divides();
}
impl Kernel for ForwardDynamicsDerivatives {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, tau, ..], [ddtheta, a, b, d_tau], w) = (c.inputs, c.outputs, &mut c.memory.workspace);
        forward_dynamics_derivatives(c.model, theta, dtheta, tau, c.environment, w, ddtheta, [a, b, d_tau]);
    }
}
