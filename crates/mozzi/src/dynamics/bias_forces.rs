//! The parts of τ: each is inverse dynamics with arguments set to zero (Modern Robotics, section 8.5).

use super::inverse_dynamics::newton_euler;
use crate::linalg::Vec3;
use crate::model::{Environment, FrameId, Model};
use crate::quantities::{Call, DTHETA, Declaration, FORCE, Kernel, Quantity, THETA, Uses, VECTOR, output};
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use crate::workspace::Workspace;
use alloc::vec::Vec;

/// h(θ, θ̇) = c + g: the joint forces at θ̈ = 0, without friction and springs. Wrenches in `environment.applied` and a
/// moving base are included, if given.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `h` not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn bias_forces<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    h: &mut [S],
) {
    let zero = take_zeros(workspace);
    h.fill(S::zero());
    newton_euler(model, theta, dtheta, &zero, environment, workspace, h);
    workspace.vector = zero;
}

/// c(θ, θ̇), the Coriolis and centripetal forces, quadratic in θ̇; base at rest.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `c` not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn velocity_product<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    c: &mut [S],
) {
    bias_forces(model, theta, dtheta, &Environment::with_gravity(Vec3::zero()), workspace, c);
}

/// g(θ), the forces that hold the robot against gravity; base at rest.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or `g` not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn gravity_forces<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    gravity: Vec3<S>,
    workspace: &mut Workspace<S>,
    g: &mut [S],
) {
    rest(model, theta, &Environment::with_gravity(gravity), workspace, g);
}

/// JᵀF: the joint forces for the wrenches that frames apply to the environment, each in its frame's coordinates.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or τ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn tip_forces<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    applied: &[(FrameId, Wrench<S>)],
    workspace: &mut Workspace<S>,
    tau: &mut [S],
) {
    let environment = Environment { applied, ..Environment::with_gravity(Vec3::zero()) };
    rest(model, theta, &environment, workspace, tau);
}

/// Inverse dynamics at rest.
#[cfg_attr(not(debug_assertions), inline(always))]
fn rest<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    tau: &mut [S],
) {
    let zero = take_zeros(workspace);
    tau.fill(S::zero());
    newton_euler(model, theta, &zero, &zero, environment, workspace, tau);
    workspace.vector = zero;
}

/// n zeros, taken from the workspace; the caller must give them back.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn take_zeros<S: Scalar>(workspace: &mut Workspace<S>) -> Vec<S> {
    let mut zero = core::mem::take(&mut workspace.vector);
    zero.fill(S::zero());
    zero
}

/// See [`bias_forces`].
#[derive(Clone, Copy, Debug)]
pub struct BiasForces;
impl Quantity for BiasForces {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "bias_forces",
        "h(θ, θ̇) = c + g, with JᵀF and the base's terms where they are given; without friction and springs",
        &[THETA, DTHETA],
        &[output("h", VECTOR, FORCE)],
    )
    .uses(Uses::ALL);
}
impl Kernel for BiasForces {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [h, ..]) = (c.inputs, c.outputs);
        bias_forces(c.model, theta, dtheta, c.environment, &mut c.memory.workspace, h);
    }
}

/// See [`velocity_product`].
#[derive(Clone, Copy, Debug)]
pub struct VelocityProduct;
impl Quantity for VelocityProduct {
    type Kernel = BiasForces;
    const DECLARATION: Declaration = Declaration::new(
        "velocity_product",
        "c(θ, θ̇) = Cθ̇, the Coriolis and centripetal forces",
        &[THETA, DTHETA],
        &[output("c", VECTOR, FORCE)],
    );
}

/// See [`gravity_forces`].
#[derive(Clone, Copy, Debug)]
pub struct GravityForces;
impl Quantity for GravityForces {
    type Kernel = BiasForces;
    const DECLARATION: Declaration = Declaration::new(
        "gravity_forces",
        "g(θ), the joint forces that hold the robot against gravity",
        &[THETA],
        &[output("g", VECTOR, FORCE)],
    )
    .uses(Uses::GRAVITY)
    .at_rest();
}

/// See [`tip_forces`].
#[derive(Clone, Copy, Debug)]
pub struct TipForces;
impl Quantity for TipForces {
    type Kernel = BiasForces;
    const DECLARATION: Declaration = Declaration::new(
        "tip_forces",
        "JᵀF of the wrenches that frames apply to the environment",
        &[THETA],
        &[output("tau", VECTOR, FORCE)],
    )
    .uses(Uses::WRENCHES)
    .at_rest();
}
