//! xᵀ∂(M(θ)a): a vector times the derivatives of a product with the mass matrix, in O(n).

use super::armature::add_rotor_forces;
use super::bias_forces::take_zeros;
use super::derivatives::outward_pass;
use super::vjp::{add_products, from_rest, of_base};
use crate::kinematics::joint_transforms;
use crate::model::Model;
use crate::quantities::{
    ANY, CONSTANT_VECTOR, Call, DDTHETA, Declaration, Kernel, Memory, Quantity, THETA, VECTOR, output, sized,
};
use crate::scalar::Scalar;
use crate::spatial::Twist;
use crate::workspace::Workspace;

/// The gradient of xᵀM(θ)θ̈ for a constant x, `[xᵀ∂(Mθ̈)/∂θ, Mx]`, each n long; along velocities.
/// `unused` is n numbers of memory.
///
/// > ½ of the first at x = θ̈ = θ̇ is ∂𝒦/∂θ
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn mass_matrix_product_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    ddtheta: &[S],
    x: &[S],
    workspace: &mut Workspace<S>,
    unused: &mut [S],
    [d_theta, d_ddtheta]: [&mut [S]; 2],
) {
    model.assert_lengths(theta.len(), [ddtheta.len(), x.len(), unused.len(), d_theta.len(), d_ddtheta.len()]);
    let (zero, environment) = (take_zeros(workspace), from_rest(Twist::zero()));
    joint_transforms(model, theta, workspace);
    outward_pass(model, theta, &zero, ddtheta, &environment, Some((of_base(model, x), x)), workspace);
    workspace.vector = zero;
    d_theta.fill(S::zero());
    for j in 0..model.n() {
        (unused[j], d_ddtheta[j]) = (S::zero(), S::from(model.armature[j]) * x[j]);
    }
    add_rotor_forces(model, x, d_ddtheta);
    add_products(model, theta, None, &environment, workspace, [d_theta, unused, d_ddtheta]);
}

/// See [`mass_matrix_product_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrixProductVjp;
impl Quantity for MassMatrixProductVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix_product_vjp",
        "xᵀ∂(M(θ)θ̈)/∂θ along the velocities, and Mx: the gradient of xᵀMθ̈",
        &[THETA, DDTHETA, CONSTANT_VECTOR],
        &[output("d_theta", VECTOR, ANY), output("d_ddtheta", VECTOR, ANY)],
    );
}
impl Kernel for MassMatrixProductVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ddtheta, x, _], [a, b, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, matrix, .. } = c.memory;
        let unused = sized(matrix, c.model.n(), S::zero());
        mass_matrix_product_vjp(c.model, theta, ddtheta, x, workspace, unused, [a, b]);
    }
}
