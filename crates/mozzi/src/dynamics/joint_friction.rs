//! Friction in the joints.

use crate::model::Model;
use crate::quantities::{Call, DTHETA, Declaration, FORCE, Kernel, Quantity, VECTOR, output};
use crate::scalar::Scalar;

/// f(θ̇) = d θ̇ + μ sgn θ̇ of joint j at its rate, with sgn 0 = 0. Sticking is not modelled: at rest Coulomb friction
/// is 0. N m or N.
///
/// # Panics
/// When there is no joint j.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn joint_friction<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, j: usize, dtheta: S) -> S {
    S::from(model.damping[j]).mul_add(dtheta, S::from(model.friction[j]) * dtheta.sgn())
}

/// See [`joint_friction`].
#[derive(Clone, Copy, Debug)]
pub struct JointFriction;
impl Quantity for JointFriction {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "joint_friction",
        "f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0",
        &[DTHETA],
        &[output("f", VECTOR, FORCE)],
    );
}
impl Kernel for JointFriction {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([dtheta, ..], [f, ..]) = (c.inputs, c.outputs);
        for (j, f) in f.iter_mut().enumerate() {
            *f = joint_friction(c.model, j, dtheta[j]);
        }
    }
}
