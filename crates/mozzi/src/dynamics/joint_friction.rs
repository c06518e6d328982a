//! Friction in the joints.

use crate::model::Model;
use crate::scalar::Scalar;

/// f(θ̇) = d θ̇ + μ sgn θ̇ of joint j at its rate, with sgn 0 = 0. Sticking is not modelled: at rest Coulomb friction is 0. N m
/// or N.
///
/// # Panics
/// When there is no joint j.
#[cfg_attr(not(test), inline(always))]
pub fn joint_friction<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, j: usize, dtheta: S) -> S {
    S::from(model.damping[j]).mul_add(dtheta, S::from(model.friction[j]) * dtheta.sgn())
}
