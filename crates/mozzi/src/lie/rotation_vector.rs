//! The rotation vector of a unit quaternion, for numbers without an order, such as recordings.

use crate::linalg::{Mat3, Vec3};
use crate::scalar::Scalar;

/// φ with e^{`[φ]`} = R(q) and ‖φ‖ ≤ π, and the terms of its derivative. At a half turn, where φ and −φ are the same
/// rotation, the sign is that of the given quaternion with w = 0.
///
/// With u = tan²(‖φ‖/4) = ‖v‖²/(|w| + ‖q‖)² and A(u) = atan(√u)/√u, φ = 4 A(u) v sgn w/(|w| + ‖q‖), without a division
/// by 0 at angle 0. A is 1 − u D(u) with D(u) = ⅓ − u/5 + u²/7 − …. First, u is made small by halving the angle twice:
/// D(u) = (1 + 2D(u')/s)/s² with s = 1 + √(1 + u), u' = u/s².
#[derive(Clone, Copy, Debug)]
pub(crate) struct RotationVector<S> {
    /// φ, rad.
    pub phi: Vec3<S>,
    /// The vector part of the unit quaternion.
    v: Vec3<S>,
    /// (1 − (‖φ‖/2) cot(‖φ‖/2))/‖v‖².
    curvature: S,
}

impl<S: Scalar> RotationVector<S> {
    /// From a quaternion (w, v) of any length but 0.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn new(w: S, v: Vec3<S>) -> Self {
        let sign = w.sgn();
        let sign = sign + S::one() - sign * sign; // 1 where w = 0
        let (w, v, square) = (w * sign, v * sign, v.dot(v));
        let length = w.mul_add(w, square).sqrt();
        let over = S::one() / (w + length);
        let u = square * over * over;
        let [over_s, u_2] = half(u);
        let [over_s2, u_4] = half(u_2);
        let D = doubled(over_s, doubled(over_s2, series(u_4)));
        let A = S::one() - u * D;
        let one_u = S::one() + u;
        RotationVector {
            phi: v * (S::from_f64(4.0) * A * over),
            v: v * (S::one() / length),
            curvature: S::from_f64(0.25) * (A + D) * one_u * one_u,
        }
    }

    /// ∂φ for a small rotation δ of the rotated body, in its own axes, q ⊗ (1, δ/2): the inverse of the right Jacobian,
    /// I + ½`[φ]` + (1 − (‖φ‖/2) cot(‖φ‖/2))/‖φ‖² `[φ]`².
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn derivative(&self) -> Mat3<S> {
        let V = Mat3::hat(self.v);
        Mat3::identity() + Mat3::hat(self.phi) * S::from_f64(0.5) + V * V * self.curvature
    }
}

/// 1/s, and u' = u/s² of half the angle.
#[cfg_attr(not(debug_assertions), inline(always))]
fn half<S: Scalar>(u: S) -> [S; 2] {
    let over = S::one() / (S::one() + (S::one() + u).sqrt());
    [over, u * over * over]
}

/// D(u) from 1/s and D(u').
#[cfg_attr(not(debug_assertions), inline(always))]
fn doubled<S: Scalar>(over: S, D: S) -> S {
    over * over * (S::from_f64(2.0) * over).mul_add(D, S::one())
}

/// D(u) = Σ (−u)ᵏ/(2k + 3) for u ≤ tan²(π/16). Each term adds 4.6 binary digits; the scalar's precision sets the number
/// of terms.
#[cfg_attr(not(debug_assertions), inline(always))]
fn series<S: Scalar>(u: S) -> S {
    let mut sum = S::zero();
    for k in (0..=S::DIGITS * 2 / 9).rev() {
        sum = S::one() / S::from_f64(2.0 * f64::from(k) + 3.0) - u * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lie::SO3;
    use crate::testing::Random;

    #[test]
    fn it_is_the_logarithm_of_either_quaternion() {
        let mut random = Random(7);
        for angle in [0.0, 1e-300, 1e-9, 1e-3, 0.5, 1.5, 3.0, core::f64::consts::PI - 1e-9] {
            let axis = Vec3(random.array());
            let axis = axis * (1.0 / axis.norm());
            let (s, c) = (0.5 * angle).sin_cos();
            for length in [1.0, -1.0, 0.3] {
                let found = RotationVector::new(c * length, axis * (s * length));
                let error = (found.phi - axis * angle).norm();
                assert!(error <= 4.0 * f64::EPSILON * angle, "{angle}: {error:e}");
                let inverse = SO3::left_jacobian_inverse(-found.phi);
                let error = found.derivative() - inverse;
                let error = error.max_abs();
                assert!(error < 20.0 * f64::EPSILON, "{angle}: {error:e}");
            }
        }
    }

    #[test]
    fn a_half_turn_is_not_lost() {
        for sign in [1.0, -1.0] {
            let found = RotationVector::new(0.0, Vec3([0.0, 0.6 * sign, 0.8 * sign])).phi;
            assert!((found - Vec3([0.0, 0.6, 0.8]) * (sign * core::f64::consts::PI)).norm() < 1e-15);
        }
    }
}
