//! Unit screw axes.

use super::{Twist, Wrench};
use crate::lie::{Adjoint, LieBracket, SE3};
use crate::linalg::Vec3;
use crate::scalar::{Real, Scalar};
use core::ops::Mul;

/// A = (ω, v): with ‖ω‖ = 1 a screw about the line of direction ω through ω × v with the pitch ωᵀv (0: revolute);
/// with ω = 0 and ‖v‖ = 1 a translation along v. Unit, checked: θ is radians (or metres) only then.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct ScrewAxis<S = f64>(Twist<S>);

/// Error: the twist given as a screw axis is not unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotAScrew {
    /// ‖ω‖.
    pub angular: f64,
    /// ‖v‖.
    pub linear: f64,
}

impl core::fmt::Display for NotAScrew {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let NotAScrew { angular, linear } = self;
        write!(
            f,
            "not a unit screw axis: ‖ω‖ = {angular} and ‖v‖ = {linear}, expected ‖ω‖ = 1, or ω = 0 and ‖v‖ = 1 (use ScrewAxis::normalize \
     and multiply this joint's θ, and divide its τ, by the size that it returns)"
        )
    }
}

impl core::error::Error for NotAScrew {}

impl ScrewAxis<f64> {
    /// From (ω, v), unit to 10⁻¹².
    ///
    /// # Errors
    /// [`NotAScrew`] when it is not unit: only the caller knows whether to rescale θ, see
    /// [`normalize`](Self::normalize).
    pub fn new(w: [f64; 3], v: [f64; 3]) -> Result<Self, NotAScrew> {
        let twist = Twist { w: Vec3(w), v: Vec3(v) };
        let (angular, linear) = (twist.w.norm(), twist.v.norm());
        let unit = |norm: f64| (norm - 1.0).abs() <= 1e-12;
        let is_screw = linear.is_finite() && (unit(angular) || angular == 0.0 && unit(linear));
        if is_screw { Ok(ScrewAxis(twist)) } else { Err(NotAScrew { angular, linear }) }
    }

    /// From (ω, v) in one array, angular first.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_array([a, b, c, x, y, z]: [f64; 6]) -> Result<Self, NotAScrew> {
        Self::new([a, b, c], [x, y, z])
    }

    /// The rotation about the line through `point` with the unit direction `axis`, sliding `pitch` metres per radian.
    ///
    /// # Errors
    /// [`NotAScrew`] when the axis is not unit.
    pub fn from_line(axis: [f64; 3], point: [f64; 3], pitch: f64) -> Result<Self, NotAScrew> {
        let w = Vec3(axis);
        Self::new(axis, (Vec3(point).cross(w) + w * pitch).0)
    }

    /// The translation along the unit vector `axis`.
    ///
    /// # Errors
    /// [`NotAScrew`] when the axis is not unit.
    pub fn prismatic(axis: [f64; 3]) -> Result<Self, NotAScrew> {
        Self::new([0.0; 3], axis)
    }

    /// Metres of slide per radian: 0 for a revolute joint, infinite for a prismatic one.
    pub fn pitch(self) -> f64 {
        if self.is_prismatic() { f64::INFINITY } else { self.0.w.dot(self.0.v) }
    }

    /// Seen from another frame: A_s = `[Ad_T]` A_b with T = `T_sb`.
    pub fn transformed(self, T_sb: crate::SE3) -> Self {
        ScrewAxis(T_sb.Ad() * self.0)
    }
}

impl<S: Real + Into<f64>> ScrewAxis<S> {
    /// The unit screw axis A along a twist V, and the size k > 0 with V = k A: a joint that was described by V and θ is
    /// described by A and kθ, and its torque by τ/k.
    ///
    /// # Errors
    /// [`NotAScrew`] when V is 0, or too large for the squares of its components.
    pub fn normalize(V: Twist<S>) -> Result<(Self, S), NotAScrew> {
        let (angular, linear) = (V.w.norm(), V.v.norm());
        let size = if angular > S::zero() { angular } else { linear };
        let axis = ScrewAxis(V * (S::one() / size));
        let is_screw = size.into() > 0.0 && size.into().is_finite() && axis.0.norm().into().is_finite();
        if is_screw { Ok((axis, size)) } else { Err(NotAScrew { angular: angular.into(), linear: linear.into() }) }
    }
}

impl<S: Scalar> ScrewAxis<S> {
    /// True if ω = 0.
    pub fn is_prismatic(self) -> bool
    where
        S: PartialEq,
    {
        self.0.w == Vec3::zero()
    }

    /// The axis after a motion T, `[Ad_T]` A.
    pub fn moved(self, T: SE3<S>) -> Self {
        ScrewAxis(T.Ad() * self.0)
    }

    /// Each number by f, a conversion between scalars.
    pub fn map<U>(self, f: impl Fn(S) -> U + Copy) -> ScrewAxis<U> {
        ScrewAxis(self.0.map(f))
    }

    /// As a twist: 1 rad/s (or 1 m/s) about the screw.
    pub fn twist(self) -> Twist<S> {
        self.0
    }

    /// AᵀF: the torque or force along the joint.
    pub fn dot(self, F: Wrench<S>) -> S {
        self.0.dot(F)
    }
}

/// `[Ad_T]` A.
impl<S: Scalar> Mul<ScrewAxis<S>> for Adjoint<S> {
    type Output = Twist<S>;
    fn mul(self, A: ScrewAxis<S>) -> Twist<S> {
        self * A.0
    }
}

/// `[ad_V]` A.
impl<S: Scalar> Mul<ScrewAxis<S>> for LieBracket<S> {
    type Output = Twist<S>;
    fn mul(self, A: ScrewAxis<S>) -> Twist<S> {
        self * A.0
    }
}

/// A θ̇: the twist of the joint's rate; or A θ, for the exponential.
impl<S: Scalar> Mul<S> for ScrewAxis<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, rate: S) -> Twist<S> {
        self.0 * rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_of_screw() {
        let helical = ScrewAxis::from_line([0.0, 0.0, 1.0], [1.0, 2.0, 3.0], 0.25).expect("unit");
        assert_eq!(helical.twist().to_array(), [0.0, 0.0, 1.0, 2.0, -1.0, 0.25]);
        assert_eq!(helical.pitch(), 0.25);
        assert!(ScrewAxis::prismatic([0.0, 0.6, 0.8]).expect("unit").is_prismatic());
    }

    #[test]
    fn what_is_not_unit_is_refused_or_rescaled_knowingly() {
        let message = ScrewAxis::new([1.0, 0.0, 1.0], [0.0, 1.0, 0.0]).expect_err("‖ω‖ = √2").to_string();
        assert!(message.contains("1.41421356"), "{message}");
        assert!(ScrewAxis::new([0.0; 3], [0.0; 3]).is_err());
        assert!(ScrewAxis::new([f64::NAN, 0.0, 1.0], [0.0; 3]).is_err());
        assert!(ScrewAxis::new([0.0, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]).is_err());
        let V = Twist::from_array([1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
        let (A, k) = ScrewAxis::normalize(V).expect("a screw");
        assert!((A * k - V).norm() < 1e-15 && (A.twist().w.norm() - 1.0).abs() < 1e-15);
        assert!(ScrewAxis::normalize(Twist::<f64>::zero()).is_err());
        assert!(ScrewAxis::normalize(Twist::from_array([1e200, 1e200, 0.0, 0.0, 0.0, 0.0])).is_err());
    }
}
