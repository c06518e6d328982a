//! Derivatives of the parts of τ by θ: each is ∂τ/∂θ with arguments set to zero.

use super::base_rates::BaseRates;
use super::bias_forces::take_zeros;
use super::composite_bodies::add_up_bodies;
use super::derivatives::outward_pass;
use super::inverse_dynamics_derivatives::fill_derivatives;
use crate::kinematics::joint_transforms;
use crate::linalg::{Square, Vec3};
use crate::model::{Environment, FrameId, Model};
use crate::quantities::{CONSTANT_VECTOR, Call, D_FORCE, Declaration, Kernel, MATRIX, Quantity, THETA, Uses, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::Wrench;
use crate::workspace::Workspace;

/// ∂g/∂θ, n × n, row-major into `dg`; base at rest. Symmetric if the base is fixed, since g is a gradient. For a
/// floating base the derivative is along its body twist, as in
/// [`InverseDynamicsDerivatives`](crate::quantities::InverseDynamicsDerivatives).
///
/// Cost O(n · depth) plus n² zeros, no allocation.
///
/// # Panics
/// When θ is not nq long, or `dg` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn gravity_forces_derivative<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    gravity: Vec3<S>,
    workspace: &mut Workspace<S>,
    dg: &mut [S],
) {
    at_rest(model, theta, None, &Environment::with_gravity(gravity), workspace, dg);
}

/// ∂(JᵀF)/∂θ, n × n, row-major into `dtau`, for wrenches that are constant in their frames' coordinates.
///
/// Cost O(n · depth) plus n² zeros, no allocation.
///
/// # Panics
/// When θ is not nq long, or `dtau` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn tip_forces_derivative<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    applied: &[(FrameId, Wrench<S>)],
    workspace: &mut Workspace<S>,
    dtau: &mut [S],
) {
    let environment = Environment { applied, ..Environment::with_gravity(Vec3::zero()) };
    at_rest(model, theta, None, &environment, workspace, dtau);
}

/// ∂(M(θ)x)/∂θ for a constant x, n × n, row-major into `dMx`. Armature is constant and drops out.
///
/// Cost O(n · depth) plus n² zeros, no allocation.
///
/// # Panics
/// When θ is not nq long, x not n, or `dMx` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn mass_matrix_product_derivative<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    x: &[S],
    workspace: &mut Workspace<S>,
    dMx: &mut [S],
) {
    at_rest(model, theta, Some(x), &Environment::with_gravity(Vec3::zero()), workspace, dMx);
}

pass! {
/// ∂τ/∂θ of inverse dynamics at θ̇ = 0, and θ̈ = 0 or as given.
fn at_rest<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    ddtheta: Option<&[S]>,
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    d_theta: &mut [S],
) {
    let zero = take_zeros(workspace);
    joint_transforms(model, theta, workspace);
    outward_pass(model, theta, &zero, ddtheta.unwrap_or(&zero), environment, None, workspace);
    let base = BaseRates::of_derivatives(model, theta, environment, workspace);
    add_up_bodies::<true, S, C>(model, workspace);
    fill_derivatives(model, base, workspace, [Square::zero(model.n(), d_theta)]);
    workspace.vector = zero;
}
}

/// See [`gravity_forces_derivative`].
#[derive(Clone, Copy, Debug)]
pub struct GravityForcesDerivative;
impl Quantity for GravityForcesDerivative {
    type Kernel = Self;
    const DECLARATION: Declaration =
        Declaration::new("gravity_forces_derivative", "∂g/∂θ", &[THETA], &[output("dg", MATRIX, D_FORCE)])
            .uses(Uses::GRAVITY);
}
impl Kernel for GravityForcesDerivative {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [dg, ..]) = (c.inputs, c.outputs);
        gravity_forces_derivative(c.model, theta, c.environment.gravity, &mut c.memory.workspace, dg);
    }
}

/// See [`tip_forces_derivative`].
#[derive(Clone, Copy, Debug)]
pub struct TipForcesDerivative;
impl Quantity for TipForcesDerivative {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "tip_forces_derivative",
        "∂(JᵀF)/∂θ of the wrenches that frames apply to the environment",
        &[THETA],
        &[output("dtau", MATRIX, D_FORCE)],
    )
    .uses(Uses::WRENCHES);
}
impl Kernel for TipForcesDerivative {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [dtau, ..]) = (c.inputs, c.outputs);
        tip_forces_derivative(c.model, theta, c.environment.applied, &mut c.memory.workspace, dtau);
    }
}

/// See [`mass_matrix_product_derivative`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrixProductDerivative;
impl Quantity for MassMatrixProductDerivative {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix_product_derivative",
        "∂(M(θ)x)/∂θ for a constant x",
        &[THETA, CONSTANT_VECTOR],
        &[output("dMx", MATRIX, "that of M x, each per unit of its column")],
    );
}
impl Kernel for MassMatrixProductDerivative {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, x, ..], [dMx, ..]) = (c.inputs, c.outputs);
        mass_matrix_product_derivative(c.model, theta, x, &mut c.memory.workspace, dMx);
    }
}
