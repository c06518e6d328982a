//! Rotor inertia (armature): a joint's own is on the diagonal of M, a rotor that several joints turn adds a JᵀJ to M,
//! and a free joint's adds a velocity product.
//!
//! A joint's armature a adds ½ a‖θ̇‖² to the kinetic energy, θ̇ being all velocities of the joint. For a joint of one
//! axis and for a ball, the force is a θ̈ alone. A free joint's velocities are a twist (ω, v) in the axes of a turning
//! link, so the linear part gives a(v̇ + ω × v).

use crate::linalg::Vec3;
use crate::model::Model;
use crate::scalar::Scalar;

/// Adds the part of M θ̈ from rotors that several joints turn.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_rotor_forces<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, ddtheta: &[S], tau: &mut [S]) {
    for rotor in &model.rotors {
        rotor.add(S::from(rotor.armature) * rotor.rate(ddtheta), tau);
    }
}

/// Sets M to the rotors' inertia alone: armature on the diagonal, and a JᵀJ for each rotor that several joints turn.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn set_armature<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, M: &mut [S]) {
    let n = model.n();
    M.fill(S::zero());
    for (j, &armature) in model.armature.iter().enumerate() {
        M[j * n + j] = S::from(armature);
    }
    for rotor in &model.rotors {
        for &(j, entry) in &rotor.J {
            rotor.add(S::from(rotor.armature) * S::from(entry), &mut M[j * n..][..n]);
        }
    }
}

/// θ̇ᵀ armature θ̇: twice the rotors' kinetic energy.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn rotor_energy<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, dtheta: &[S]) -> S {
    let mut twice = S::zero();
    for (&armature, &rate) in model.armature.iter().zip(dtheta) {
        twice += S::from(armature) * rate * rate;
    }
    for rotor in &model.rotors {
        let rate = rotor.rate(dtheta);
        twice += S::from(rotor.armature) * rate * rate;
    }
    twice
}

/// Adds a ω × v to the linear rows of each free joint.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_velocity_products<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, dtheta: &[S], tau: &mut [S]) {
    for &j in &model.structure.free {
        let (w, v) = of_free_joint(dtheta, j);
        let a = S::from(model.armature[j]);
        for (k, x) in w.cross(v).0.into_iter().enumerate() {
            tau[j + 3 + k] = a.mul_add(x, tau[j + 3 + k]);
        }
    }
}

/// Adds ∂(a ω × v)/∂θ̇ to ∂τ/∂θ̇.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_velocity_product_rates<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, dtheta: &[S], X: &mut [S]) {
    for &j in &model.structure.free {
        let (w, v) = of_free_joint(dtheta, j);
        let a = S::from(model.armature[j]);
        add_cross(model.n(), X, [j + 3, j], v * -a);
        add_cross(model.n(), X, [j + 3, j + 3], w * a);
    }
}

/// Adds xᵀ∂(a ω × v)/∂θ̇.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_velocity_product_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    dtheta: &[S],
    x: &[S],
    d_dtheta: &mut [S],
) {
    for &j in &model.structure.free {
        let ((w, v), (_, x)) = (of_free_joint(dtheta, j), of_free_joint(x, j));
        let a = S::from(model.armature[j]);
        let (by_w, by_v) = (v.cross(x), x.cross(w));
        for k in 0..3 {
            d_dtheta[j + k] = a.mul_add(by_w.0[k], d_dtheta[j + k]);
            d_dtheta[j + 3 + k] = a.mul_add(by_v.0[k], d_dtheta[j + 3 + k]);
        }
    }
}

/// Adds the block of C that gives a ω × v: a`[ω]` in the linear block. It is skew-symmetric, since the armature's part
/// of M is constant.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_coriolis_blocks<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, dtheta: &[S], X: &mut [S]) {
    for &j in &model.structure.free {
        let (w, _) = of_free_joint(dtheta, j);
        add_cross(model.n(), X, [j + 3, j + 3], w * S::from(model.armature[j]));
    }
}

/// (ω, v) of the free joint whose first velocity has the index j.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn of_free_joint<S: Scalar>(dtheta: &[S], j: usize) -> (Vec3<S>, Vec3<S>) {
    let of = |first: usize| Vec3(core::array::from_fn(|k| dtheta[first + k]));
    (of(j), of(j + 3))
}

/// Adds `[x]` to the block of X whose first entry is at (row, column).
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_cross<S: Scalar>(n: usize, X: &mut [S], [row, column]: [usize; 2], x: Vec3<S>) {
    for (r, entries) in crate::linalg::Mat3::hat(x).rows().into_iter().enumerate() {
        for (c, entry) in entries.into_iter().enumerate() {
            X[(row + r) * n + column + c] += entry;
        }
    }
}
