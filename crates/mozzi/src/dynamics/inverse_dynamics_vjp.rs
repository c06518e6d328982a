//! xᵀ∂τ: a vector times the derivatives of inverse dynamics, in O(n), without the matrices: see
//! [`vjp.rs`](super::vjp).

use super::armature::{add_rotor_forces, add_velocity_product_vjp};
use super::derivatives::outward_pass;
use super::vjp::{add_products, of_base};
use crate::kinematics::joint_transforms;
use crate::model::{Environment, Model};
use crate::quantities::{
    ANY, CONSTANT_VECTOR, Call, DDTHETA, DTHETA, Declaration, Kernel, Quantity, THETA, Uses, VECTOR, output,
};
use crate::scalar::{Scalar, pass};
use crate::workspace::Workspace;

/// The vector-Jacobian products of [`inverse_dynamics`](super::inverse_dynamics()), `[xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇, xᵀ∂τ/∂θ̈]`,
/// each n long: the gradient of xᵀτ for a constant x, which is n long.
///
/// They are xᵀ times the matrices of [`inverse_dynamics_derivatives`](super::inverse_dynamics_derivatives()), with the
/// same conventions: an entry of xᵀ∂τ/∂θ is along a velocity. xᵀ∂τ/∂θ̈ is Mx.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // the derivatives', and x
pub fn inverse_dynamics_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    [d_theta, d_dtheta, d_ddtheta]: [&mut [S]; 3],
) {
    model.assert_lengths(theta.len(), [x.len(), d_theta.len(), d_dtheta.len(), d_ddtheta.len()]);
    joint_transforms(model, theta, workspace);
    from_transforms(model, theta, dtheta, ddtheta, x, environment, workspace, [d_theta, d_dtheta, d_ddtheta]);
}

pass! {
/// As [`inverse_dynamics_vjp`]; requires T_{i,i−1}(θ) in the workspace.
pub(super) fn from_transforms<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    products: [&mut [S]; 3],
) {
    let [d_theta, d_dtheta, d_ddtheta] = products;
    outward_pass(model, theta, dtheta, ddtheta, environment, Some((of_base(model, x), x)), workspace);
    for j in 0..model.n() {
        d_theta[j] = S::zero();
        d_dtheta[j] = S::from(model.damping[j]) * x[j];
        d_ddtheta[j] = S::from(model.armature[j]) * x[j];
    }
    for spring in &model.springs {
        spring.add_vjp(theta, x, d_theta);
    }
    add_velocity_product_vjp(model, dtheta, x, d_dtheta);
    add_rotor_forces(model, x, d_ddtheta);
    add_products(model, theta, None, environment, workspace, [d_theta, d_dtheta, d_ddtheta]);
}
}

/// See [`inverse_dynamics_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamicsVjp;
#[doc(hidden)]
impl Quantity for InverseDynamicsVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics_vjp",
        "xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities",
        &[THETA, DTHETA, DDTHETA, CONSTANT_VECTOR],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY), output("d_ddtheta", VECTOR, ANY)],
    )
    .uses(Uses::ALL);
}
#[doc(hidden)]
impl Kernel for InverseDynamicsVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, x], [a, b, d, _]) = (c.inputs, c.outputs);
        let (workspace, outputs) = (&mut c.memory.workspace, [a, b, d]);
        inverse_dynamics_vjp(c.model, theta, dtheta, ddtheta, x, c.environment, workspace, outputs);
    }
}
