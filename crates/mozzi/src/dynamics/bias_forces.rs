//! The parts of τ: each is inverse dynamics with arguments set to zero (Modern Robotics, section 8.5).

use super::inverse_dynamics::newton_euler;
use crate::linalg::Vec3;
use crate::model::{Environment, FrameId, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use alloc::vec::Vec;

/// h(θ, θ̇) = c + g: what the joints must carry at θ̈ = 0. Without friction. Wrenches in `environment.applied` and a
/// base that moves are counted in, where they are given.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `h` not n.
#[cfg_attr(not(test), inline(always))]
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
#[cfg_attr(not(test), inline(always))]
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
#[cfg_attr(not(test), inline(always))]
pub fn gravity_forces<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    gravity: Vec3<S>,
    workspace: &mut Workspace<S>,
    g: &mut [S],
) {
    rest(model, theta, &Environment::with_gravity(gravity), workspace, g);
}

/// JᵀF: what the joints must carry for the wrenches that frames apply to the environment, each in its frame's
/// coordinates.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or τ not n.
#[cfg_attr(not(test), inline(always))]
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
#[cfg_attr(not(test), inline(always))]
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

/// n zeros, lent by the workspace: to be given back.
#[inline(always)]
pub(super) fn take_zeros<S: Scalar>(workspace: &mut Workspace<S>) -> Vec<S> {
    let mut zero = core::mem::take(&mut workspace.vector);
    zero.fill(S::zero());
    zero
}
