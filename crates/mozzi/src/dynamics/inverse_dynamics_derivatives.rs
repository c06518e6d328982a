//! ∂τ of inverse dynamics, by every argument at once.

use super::armature::add_velocity_product_rates;
use super::derivatives::derivatives;
use super::spring_forces::add_stiffness;
use crate::kinematics::joint_transforms;
use crate::model::{Environment, Model, Workspace};
use crate::quantity::{
    Call, D_FORCE, DDTHETA, DTHETA, Declaration, Kernel, MATRIX, Quantity, THETA, Uses, output, symmetric,
};
use crate::scalar::Scalar;

/// The derivatives of [`inverse_dynamics`](super::inverse_dynamics()), `[∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M]`, each n × n,
/// row-major: row i is τ_i's.
///
/// Column j of ∂τ/∂θ is along the j-th velocity, θ ⊕ e_j ε as [`integrate`](crate::integrate) moves it: an entry of θ
/// for a joint, the body twist of a floating base, in its own coordinates. Applied wrenches keep their coordinates in
/// their frames, and {s} keeps its motion. Springs add k to the diagonal of ∂τ/∂θ, friction d to that of ∂τ/∂θ̇ (the
/// derivative of sgn is 0), armature to that of M. N m, N per rad, m, rad/s, ….
///
/// Entries are 0 unless [`couples`](Model::couples) i and j.
///
/// Cost O(n · depth) plus 3 n² zeros, no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ or θ̈ not n, or a derivative not n².
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn inverse_dynamics_derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, [d_theta, d_dtheta, M]: [&mut [S]; 3],
) {
    joint_transforms(model, theta, workspace);
    derivatives(model, theta, dtheta, ddtheta, environment, workspace, d_theta, Some(&mut *d_dtheta), Some(M));
    add_stiffness(model, theta, d_theta);
    add_velocity_product_rates(model, dtheta, d_dtheta);
}

/// See [`inverse_dynamics_derivatives`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamicsDerivatives;
impl Quantity for InverseDynamicsDerivatives {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics_derivatives",
        "∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities",
        &[THETA, DTHETA, DDTHETA],
        &[
            output("d_theta", MATRIX, D_FORCE),
            output("d_dtheta", MATRIX, D_FORCE),
            symmetric("d_ddtheta", MATRIX, D_FORCE),
        ],
    )
    .uses(Uses::ALL);
}
impl Kernel for InverseDynamicsDerivatives {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [a, b, M, _]) = (c.inputs, c.outputs);
        inverse_dynamics_derivatives(
            c.model,
            theta,
            dtheta,
            ddtheta,
            c.environment,
            &mut c.memory.workspace,
            [a, b, M],
        );
    }
}
