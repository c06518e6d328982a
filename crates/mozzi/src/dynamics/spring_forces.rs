//! Springs in the joints.

use crate::model::Model;
use crate::quantities::{Call, Declaration, FORCE, Kernel, Quantity, THETA, VECTOR, output};
use crate::scalar::Scalar;

/// f_s(θ) = k(θ − θ₀) of each velocity, N m or N: the forces that hold the joints against their springs. θ is not
/// wrapped. A mimic joint's spring acts on q = ratio θ + offset and adds ratio k(q − θ₀) to its source joint. A ball's
/// is kφ in the axes of its link, φ being the rotation vector, ‖φ‖ ≤ π, of its quaternion: the spring acts along the
/// shorter rotation, and its force jumps at a half turn.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or `f` not n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn spring_forces<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], f: &mut [S]) {
    model.assert_lengths(theta.len(), [f.len()]);
    f.fill(S::zero());
    add_spring_forces(model, theta, f);
}

/// Adds f_s to a force.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn add_spring_forces<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], tau: &mut [S]) {
    for spring in &model.springs {
        spring.add_force(theta, tau);
    }
}

/// Adds ∂f_s/∂θ to ∂τ/∂θ.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_stiffness<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], d_theta: &mut [S]) {
    for spring in &model.springs {
        spring.add_stiffness(model.n(), theta, d_theta);
    }
}

/// See [`spring_forces`].
#[derive(Clone, Copy, Debug)]
pub struct SpringForces;
impl Quantity for SpringForces {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "spring_forces",
        "f_s(θ) = k(θ − θ₀) of each joint, θ not wrapped; kφ of a ball, φ its rotation vector",
        &[THETA],
        &[output("f", VECTOR, FORCE)],
    );
}
impl Kernel for SpringForces {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [f, ..]) = (c.inputs, c.outputs);
        spring_forces(c.model, theta, f);
    }
}
