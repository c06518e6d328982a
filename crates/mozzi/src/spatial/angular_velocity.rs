//! Twists about a frame's origin.

use super::{SpatialInertia, Twist, Wrench};
use crate::lie::Adjoint;
use crate::linalg::Vec3;
use crate::scalar::Scalar;
use core::ops::{Mul, Neg, Sub};

/// (ω, 0): the twist of a body that rotates about its frame's origin. Products with it skip the multiplications by its
/// zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AngularVelocity<S>(pub Vec3<S>);

/// `[ad_V]`ᵀ of an angular velocity.
#[derive(Clone, Copy)]
pub(crate) struct SpinBracketTranspose<S>(Vec3<S>);

/// `[ad_V]`ᵀP of an angular velocity and a momentum, (m × ω, f × ω), kept as factors so that each product is fused with
/// the subtraction that follows.
#[derive(Clone, Copy)]
pub(crate) struct GyroscopicWrench<S> {
    w: Vec3<S>,
    P: Wrench<S>,
}

impl<S: Scalar> AngularVelocity<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn twist(self) -> Twist<S> {
        Twist { w: self.0, v: Vec3::zero() }
    }

    /// `[ad_V]`ᵀ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn ad_transpose(self) -> SpinBracketTranspose<S> {
        SpinBracketTranspose(self.0)
    }
}

impl<S: Scalar> Twist<S> {
    /// ω alone.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn spin(self) -> AngularVelocity<S> {
        AngularVelocity(self.w)
    }

    /// The classical acceleration of a frame with the twist V = `self` and its rate V̇: (ω, 0), and (ω̇, v̇ + ω × v),
    /// whose linear part is the acceleration of the origin. This is the motion in a frame that moves, at this moment,
    /// with the origin, in a straight line at constant speed.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn classical_acceleration(self, dV: Self) -> (AngularVelocity<S>, Self) {
        (self.spin(), Twist { w: dV.w, v: self.w.cross_add(self.v, dV.v) })
    }
}

impl<S: Scalar> Mul<AngularVelocity<S>> for Adjoint<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: AngularVelocity<S>) -> Twist<S> {
        let w = self.0.R * V.0;
        Twist { w, v: self.0.p.cross(w) }
    }
}

/// 𝒢V: the momentum.
impl<S: Scalar> Mul<AngularVelocity<S>> for SpatialInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: AngularVelocity<S>) -> Wrench<S> {
        Wrench { m: self.I * V.0, f: V.0.cross(self.mc) }
    }
}

impl<S: Scalar> Mul<Wrench<S>> for SpinBracketTranspose<S> {
    type Output = GyroscopicWrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, P: Wrench<S>) -> GyroscopicWrench<S> {
        GyroscopicWrench { w: self.0, P }
    }
}

impl<S: Scalar> Neg for GyroscopicWrench<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn neg(self) -> Wrench<S> {
        Wrench { m: self.w.cross(self.P.m), f: self.w.cross(self.P.f) }
    }
}

impl<S: Scalar> Sub<GyroscopicWrench<S>> for Wrench<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn sub(self, o: GyroscopicWrench<S>) -> Self {
        Wrench { m: o.w.cross_add(o.P.m, self.m), f: o.w.cross_add(o.P.f, self.f) }
    }
}

#[cfg(test)]
mod tests {
    use crate::lie::SE3;
    use crate::testing::{inertia, twist, wrench};

    #[test]
    fn the_short_forms_equal_the_general_ones() {
        let (V, G, F, Ad) = (twist(1).spin(), inertia(2), wrench(3), SE3::exp(twist(4)).Ad());
        assert!((Ad * V - Ad * V.twist()).norm() < 1e-15);
        assert!((G * V - G * V.twist()).norm() < 1e-15);
        let general = F - V.twist().ad().transpose() * (G * V);
        assert!((F - V.ad_transpose() * (G * V) - general).norm() < 1e-14);
    }

    #[test]
    fn an_observer_in_uniform_motion_sees_the_same_wrench() {
        let (V, dV, G) = (twist(1), twist(2), inertia(3));
        let (spin, dV_0) = V.classical_acceleration(dV);
        let F = G * dV - V.ad().transpose() * (G * V);
        assert!((G * dV_0 - spin.ad_transpose() * (G * spin) - F).norm() < 1e-13);
    }
}
