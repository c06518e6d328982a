//! The base link's configuration and motion: slot 0 of the kernels, fixed to {s} or free in SE(3).

use crate::lie::SE3;
use crate::model::{Environment, Model};
use crate::scalar::Scalar;
use crate::spatial::Twist;

/// `T_sb` of the base link: the first seven positions of a floating base, else I.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn base_pose<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S]) -> SE3<S> {
    match theta.first_chunk() {
        Some(&pose) if model.is_floating() => SE3::from_pose(pose),
        _ => SE3::identity(),
    }
}

/// 𝒱_b and 𝒱̇_b of the base link in its own coordinates. A fixed base moves with {s}; a floating base moves relative to
/// {s} like a link on a joint with the axes I:
///
/// > 𝒱_b = Ad 𝒱_s + 𝒱, 𝒱̇_b = Ad 𝒱̇_s + `[ad_𝒱_b]` 𝒱 + 𝒱̇, with (𝒱, 𝒱̇) the first six velocities and accelerations
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(crate) fn base_motion<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], environment: &Environment<S>,
) -> (Twist<S>, Twist<S>) {
    let (V_s, dV_s) = (environment.base_twist, environment.proper_base_acceleration());
    let (Some(&V), Some(&dV), true) = (dtheta.first_chunk(), ddtheta.first_chunk(), model.is_floating()) else {
        return (V_s, dV_s);
    };
    let (V, dV) = (Twist::from_array(V), Twist::from_array(dV));
    let Ad = base_pose(model, theta).inverse().Ad();
    let V_b = Ad * V_s + V;
    (V_b, Ad * dV_s + V_b.ad() * V + dV)
}

/// 𝒱_b alone, {s} moving with `V_s`.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(crate) fn base_twist<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], dtheta: &[S], V_s: Twist<S>) -> Twist<S> {
    match dtheta.first_chunk() {
        Some(&V) if model.is_floating() => base_pose(model, theta).inverse().Ad() * V_s + Twist::from_array(V),
        _ => V_s,
    }
}
