//! Friction in the joints.

use crate::model::Model;
use crate::scalar::Scalar;

/// f(θ̇) = d θ̇ + μ sgn θ̇ of joint j, with sgn 0 = 0. Sticking is not modelled: at rest Coulomb friction is 0.
#[inline(always)]
pub(crate) fn joint_friction<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, j: usize, dtheta: S) -> S {
    S::from(model.damping[j]) * dtheta + S::from(model.friction[j]) * dtheta.sgn()
}
