//! SE(3): rigid motions and configurations of frames.

use super::Twist;
use super::{InvalidRotation, SO3};
use crate::linalg::{Mat3, Vec3};
use crate::scalar::{Real, Scalar};
use core::ops::Mul;

/// T = (R, p): `T_sb` is the configuration of frame {b} relative to frame {s}.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SE3<S = f64> {
    /// Orientation.
    pub R: SO3<S>,
    /// Position of the origin.
    pub p: Vec3<S>,
}

impl<S: Scalar> SE3<S> {
    /// From orientation and position.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn new(R: SO3<S>, p: Vec3<S>) -> Self {
        SE3 { R, p }
    }

    /// I.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn identity() -> Self {
        SE3 { R: SO3::identity(), p: Vec3::zero() }
    }

    /// (I, p).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn translation(p: [S; 3]) -> Self {
        SE3 { R: SO3::identity(), p: Vec3(p) }
    }

    /// T⁻¹ = (Rᵀ, −Rᵀp).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn inverse(self) -> Self {
        SE3 { R: self.R.inverse(), p: -self.R.inverse_mul(self.p) }
    }

    /// From the quaternion (w, x, y, z) of the orientation, of any length but 0, and the origin (x, y, z).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn from_pose([w, x, y, z, px, py, pz]: [S; 7]) -> Self {
        SE3 { R: SO3::from_quaternion(w, Vec3([x, y, z])), p: Vec3([px, py, pz]) }
    }

    /// The 4 × 4 matrix, as rows.
    pub fn to_matrix(self) -> [[S; 4]; 4] {
        let ([x, y, z], [px, py, pz]) = (self.R.matrix().rows(), self.p.0);
        let row = |[a, b, c]: [S; 3], d| [a, b, c, d];
        [row(x, px), row(y, py), row(z, pz), row([S::zero(); 3], S::one())]
    }

    /// Each entry by f, a conversion between scalars.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U + Copy) -> SE3<U> {
        SE3 { R: self.R.map(f), p: self.p.map(f) }
    }
}

/// Error: the matrix is not a configuration in SE(3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InvalidConfiguration {
    /// Its upper left 3 × 3 block.
    Rotation(InvalidRotation),
    /// Its last row.
    LastRow([f64; 4]),
}

impl core::fmt::Display for InvalidConfiguration {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            InvalidConfiguration::Rotation(error) => error.fmt(f),
            InvalidConfiguration::LastRow(row) => {
                write!(f, "not a configuration: the last row is {row:?}, expected [0, 0, 0, 1]")
            }
        }
    }
}

impl core::error::Error for InvalidConfiguration {}

impl From<InvalidRotation> for InvalidConfiguration {
    fn from(error: InvalidRotation) -> Self {
        InvalidConfiguration::Rotation(error)
    }
}

impl SE3<f64> {
    /// From a 4 × 4 matrix, as rows.
    ///
    /// # Errors
    /// If the upper left block is not a rotation to 10⁻¹², or the last row is not (0, 0, 0, 1).
    pub fn from_matrix(T: [[f64; 4]; 4]) -> Result<Self, InvalidConfiguration> {
        Self::from_rows(T, SO3::from_matrix)
    }

    /// From a 4 × 4 matrix, as rows, whose rotation may have rounded numbers: see [`SO3::from_rounded_matrix`].
    ///
    /// # Errors
    /// If the upper left block is not a rotation to 10⁻³, or the last row is not (0, 0, 0, 1).
    pub fn from_rounded_matrix(T: [[f64; 4]; 4]) -> Result<Self, InvalidConfiguration> {
        Self::from_rows(T, SO3::from_rounded_matrix)
    }

    fn from_rows(
        T: [[f64; 4]; 4],
        rotation: impl Fn(Mat3) -> Result<SO3, InvalidRotation>,
    ) -> Result<Self, InvalidConfiguration> {
        if T[3] != [0.0, 0.0, 0.0, 1.0] {
            return Err(InvalidConfiguration::LastRow(T[3]));
        }
        let row = |i: usize| [T[i][0], T[i][1], T[i][2]];
        let R = rotation(Mat3::from_rows([row(0), row(1), row(2)]))?;
        Ok(SE3 { R, p: Vec3([T[0][3], T[1][3], T[2][3]]) })
    }
}

impl<S: Real> SE3<S> {
    /// e^{`[ξ]`}: the motion after one second at the constant twist ξ = (ω, v) (Modern Robotics 3.88, for any ‖ω‖).
    /// For a joint, e^{`[S]`θ} is `SE3::exp(S * theta)`.
    pub fn exp(xi: Twist<S>) -> Self {
        SE3 { R: SO3::exp(xi.w), p: SO3::left_jacobian(xi.w) * xi.v }
    }

    /// The unit quaternion (w, x, y, z) of the orientation, w ≥ 0, and the origin (x, y, z): the format of a floating
    /// base's configuration in θ.
    pub fn to_pose(self) -> [S; 7] {
        let ((w, Vec3([x, y, z])), [px, py, pz]) = (self.R.quaternion(), self.p.0);
        [w, x, y, z, px, py, pz]
    }

    /// ξ with e^{`[ξ]`} = T and ‖ω‖ ≤ π.
    pub fn log(self) -> Twist<S> {
        let w = self.R.log();
        Twist { w, v: SO3::left_jacobian_inverse(w) * self.p }
    }
}

impl<S: Scalar> Mul for SE3<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, o: Self) -> Self {
        SE3 { R: self.R * o.R, p: self.R * o.p + self.p }
    }
}

/// T acting on a point: Rx + p.
impl<S: Scalar> Mul<Vec3<S>> for SE3<S> {
    type Output = Vec3<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, x: Vec3<S>) -> Vec3<S> {
        self.R * x + self.p
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{distance, twist};
    use core::f64::consts::PI;

    #[test]
    fn log_undoes_exp_at_every_angle() {
        for angle in [0.0, 1e-200, 1e-9, 1e-5, 0.2, 0.99, 1.01, 3.0, PI - 1e-6, PI - 1e-12] {
            let xi = Twist { w: Vec3([2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0]) * angle, v: Vec3([0.3, -2.0, 0.7]) };
            let back = SE3::exp(xi).log();
            assert!((back.w - xi.w).norm() <= 8.0 * f64::EPSILON * angle, "{angle}");
            assert!((back.v - xi.v).norm() <= 16.0 * f64::EPSILON * xi.v.norm(), "{angle}");
        }
    }

    #[test]
    fn exp_is_the_limit_of_many_small_motions() {
        // (I + [ξ]/2ᵏ + …) squared k times: independent of Rodrigues' formula
        let xi = Twist { w: Vec3([0.4, -0.2, 0.9]), v: Vec3([1.0, 0.5, -0.3]) };
        let small = xi * (1.0 / 1048576.0);
        let W = Mat3::hat(small.w);
        let mut T = SE3 {
            R: SO3(Mat3::identity() + W + W * W * 0.5 + W * W * W * (1.0 / 6.0)),
            p: small.v + W * small.v * 0.5 + W * (W * small.v) * (1.0 / 6.0),
        };
        for _ in 0..20 {
            T = T * T;
        }
        assert!(distance(T, SE3::exp(xi)) < 1e-9);
    }

    #[test]
    fn inverse_and_point() {
        let T = SE3::exp(twist(1));
        assert!(distance(T * T.inverse(), SE3::identity()) < 1e-15);
        let x = Vec3([0.1, 0.2, 0.3]);
        assert!((T.inverse() * (T * x) - x).norm() < 1e-15);
        let again = SE3::from_matrix(T.to_matrix()).expect("a configuration");
        assert_eq!(again, T);
    }
}
