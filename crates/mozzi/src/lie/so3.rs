//! SO(3): rotations.

use super::series;
use crate::linalg::{Mat3, Vec3};
use crate::scalar::{Real, Scalar};
use core::ops::Mul;

/// The numbers of a rotation matrix may be rounded by this: float32, printed digits.
const ROUNDED: f64 = 1e-3;

/// A rotation, as its matrix R with RᵀR = I and det R = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct SO3<S = f64>(pub(crate) Mat3<S>);

/// Error: the matrix is not a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvalidRotation {
    /// The largest entry of |RᵀR − I|.
    pub deviation: f64,
    /// The tolerance.
    pub tolerance: f64,
    /// det R.
    pub determinant: f64,
}

impl core::fmt::Display for InvalidRotation {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let InvalidRotation { deviation, tolerance, determinant } = self;
        write!(
            f,
            "not a rotation matrix: RᵀR differs from I by up to {deviation:.3e} (expected at most {tolerance:.0e}) and det R = {determinant:.6} (expected 1)"
        )
    }
}

impl core::error::Error for InvalidRotation {}

impl<S: Scalar> SO3<S> {
    /// I.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn identity() -> Self {
        SO3(Mat3::identity())
    }

    /// The matrix R.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn matrix(self) -> Mat3<S> {
        self.0
    }

    /// R⁻¹ = Rᵀ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn inverse(self) -> Self {
        SO3(self.0.transpose())
    }

    /// R⁻¹v.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn inverse_mul(self, v: Vec3<S>) -> Vec3<S> {
        self.0.transpose_mul(v)
    }

    /// Rot(z, yaw) Rot(y, pitch) Rot(x, roll): roll, pitch and yaw in radians about the fixed axes, as in URDF.
    pub fn from_rpy(roll: S, pitch: S, yaw: S) -> Self {
        let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        SO3(Mat3::from_rows([
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]))
    }

    /// The rotation of a quaternion (s, v), of any length but 0: R = I + 2 (s`[v]` + `[v]`²) / (s² + ‖v‖²).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn from_quaternion(s: S, v: Vec3<S>) -> Self {
        let two_over = S::from_f64(2.0) / (s * s + v.dot(v));
        let (Vec3([x, y, z]), Vec3([sx, sy, sz])) = (v * two_over, v * (s * two_over));
        let Vec3([a, b, c]) = v;
        let (xx, yy, zz, xy, xz, yz) = (x * a, y * b, z * c, x * b, x * c, y * c);
        let one = S::one();
        SO3(Mat3::from_rows([
            [one - yy - zz, xy - sz, xz + sy],
            [xy + sz, one - xx - zz, yz - sx],
            [xz - sy, yz + sx, one - xx - yy],
        ]))
    }

    /// Each entry by f, a conversion between scalars.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U) -> SO3<U> {
        SO3(self.0.map(f))
    }
}

impl SO3<f64> {
    /// A rotation from its matrix.
    ///
    /// # Errors
    /// When RᵀR = I and det R = 1 do not hold to 10⁻¹², [`InvalidRotation`] with the numbers: see [`SO3::nearest`].
    pub fn from_matrix(R: Mat3) -> Result<Self, InvalidRotation> {
        let (deviation, tolerance, determinant) = (from_orthogonal(R), 1e-12, R.determinant());
        // written so that NaN is rejected
        if deviation <= tolerance && determinant > 0.0 {
            Ok(SO3(R))
        } else {
            Err(InvalidRotation { deviation, tolerance, determinant })
        }
    }

    /// A rotation from its matrix, whose numbers may be rounded, such as float32 or printed digits: as
    /// [`from_matrix`](Self::from_matrix), or the [nearest](Self::nearest) if no entry changes by 10⁻³.
    ///
    /// # Errors
    /// [`InvalidRotation`].
    pub fn from_rounded_matrix(R: Mat3) -> Result<Self, InvalidRotation> {
        Self::from_matrix(R).or_else(|error| match Self::nearest(R) {
            Ok((nearest, distance)) if distance < ROUNDED => Ok(nearest),
            _ => Err(InvalidRotation { tolerance: ROUNDED, ..error }),
        })
    }

    /// The rotation nearest to a matrix B in the Frobenius norm (its polar factor), and the largest entry of |R − B|.
    /// For matrices with truncated digits.
    ///
    /// # Errors
    /// If det B is not in ½ … 2.
    pub fn nearest(B: Mat3) -> Result<(Self, f64), InvalidRotation> {
        let determinant = B.determinant();
        if !(0.5..=2.0).contains(&determinant) {
            return Err(InvalidRotation { deviation: from_orthogonal(B), tolerance: 0.5, determinant });
        }
        let mut R = B;
        for _ in 0..20 {
            // Newton: R ← (R + R⁻ᵀ)/2, where R⁻ᵀ has the rows y × z, z × x, x × y over det R
            let cofactors = Mat3 { x: R.y.cross(R.z), y: R.z.cross(R.x), z: R.x.cross(R.y) };
            R = (R + cofactors * (1.0 / R.determinant())) * 0.5;
        }
        Ok((SO3(R), (R - B).max_abs()))
    }
}

/// The largest entry of |BᵀB − I|.
fn from_orthogonal(B: Mat3) -> f64 {
    (B.transpose() * B - Mat3::identity()).max_abs()
}

impl<S: Real> SO3<S> {
    /// e^{`[ω]`}: the rotation by ‖ω‖ radians about ω (Rodrigues; Modern Robotics 3.51).
    pub fn exp(w: Vec3<S>) -> Self {
        let (z, W) = (w.dot(w), Mat3::hat(w));
        SO3(Mat3::identity() + W * series::sinc(z) + W * W * series::cosc(z))
    }

    /// ω with e^{`[ω]`} = R and ‖ω‖ ≤ π, computed from the unit quaternion: accurate at every angle. At a half turn
    /// both signs of ω are valid.
    pub fn log(self) -> Vec3<S> {
        let (s, v) = self.quaternion();
        v * series::angle_over_sine(v.dot(v), s)
    }

    /// The unit quaternion (s, v) with s ≥ 0: the largest of its four components first, the others from it.
    pub fn quaternion(self) -> (S, Vec3<S>) {
        let ([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]], one, half) = (self.0.rows(), S::one(), S::from_f64(0.5));
        let squares = [one + xx + yy + zz, one + xx - yy - zz, one - xx + yy - zz, one - xx - yy + zz]; // 4 s², 4 x², …
        let largest = (1..4).fold(0, |m, i| if squares[i] > squares[m] { i } else { m });
        let root = squares[largest].sqrt();
        let q = [
            [root * root, zy - yz, xz - zx, yx - xy],
            [zy - yz, root * root, xy + yx, xz + zx],
            [xz - zx, xy + yx, root * root, yz + zy],
            [yx - xy, xz + zx, yz + zy, root * root],
        ][largest]
            .map(|c| c * half / root);
        let [s, x, y, z] = if q[0] < S::zero() { q.map(|c| -c) } else { q };
        (s, Vec3([x, y, z]))
    }

    /// The left Jacobian J of exp at ω: e^{`[ω + δ]`} ≈ e^{`[J δ]`} e^{`[ω]`}.
    pub(crate) fn left_jacobian(w: Vec3<S>) -> Mat3<S> {
        let (z, W) = (w.dot(w), Mat3::hat(w));
        Mat3::identity() + W * series::cosc(z) + W * W * series::sinc3(z)
    }

    /// J⁻¹.
    pub(crate) fn left_jacobian_inverse(w: Vec3<S>) -> Mat3<S> {
        let (z, W) = (w.dot(w), Mat3::hat(w));
        Mat3::identity() - W * S::from_f64(0.5) + W * W * series::cotc(z)
    }
}

impl<S: Scalar> Mul for SO3<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, o: Self) -> Self {
        SO3(self.0 * o.0)
    }
}

impl<S: Scalar> Mul<Vec3<S>> for SO3<S> {
    type Output = Vec3<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        self.0 * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    #[test]
    fn log_undoes_exp_at_every_angle() {
        let axis = Vec3([2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0]);
        let angles = [0.0, 1e-300, 1e-12, 1e-9, 1e-8, 1e-4, 0.3, 1.0, 2.0, 3.0, PI - 1e-4, PI - 1e-8, PI - 1e-13];
        for angle in angles {
            let w = axis * angle;
            let back = SO3::exp(w).log();
            let error = (back - w).norm() / (f64::EPSILON * if angle > 0.0 { angle.max(1e-290) } else { 1.0 });
            assert!(error < 8.0, "angle {angle}: {error} eps");
        }
    }

    #[test]
    fn quaternions_have_a_scalar_part_of_at_least_0() {
        for axis in [[1.0_f64, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, -0.8], [-0.6, 0.48, 0.64]] {
            for angle in [0.1, 1.5, 2.5, 3.1, -1.5, -2.5, -3.1] {
                let w = Vec3(axis) * angle;
                let (s, v) = SO3::exp(w).quaternion();
                let half = 0.5_f64 * angle;
                assert!((s - half.cos()).abs() < 4.0 * f64::EPSILON && s >= 0.0, "{s} of {angle} about {axis:?}");
                assert!((v - Vec3(axis) * half.sin()).norm() < 4.0 * f64::EPSILON, "{v:?}");
            }
        }
    }

    #[test]
    fn a_half_turn_has_its_axis() {
        for axis in [[1.0_f64, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, -0.8]] {
            let R = SO3(Mat3::from_rows(
                [0, 1, 2].map(|i| [0, 1, 2].map(|j| 2.0 * axis[i] * axis[j] - if i == j { 1.0 } else { 0.0 })),
            ));
            let w = R.log();
            let sign = w.dot(Vec3(axis)).signum();
            assert!((w * sign - Vec3(axis) * PI).norm() < 8.0 * f64::EPSILON);
        }
    }

    #[test]
    #[allow(clippy::approx_constant)] // on purpose
    fn what_is_no_rotation_is_refused_with_numbers() {
        let mirror = Mat3::from_rows([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
        assert!(SO3::from_matrix(mirror).is_err());
        let cut = Mat3::from_rows([[0.7071, -0.7071, 0.0], [0.7071, 0.7071, 0.0], [0.0, 0.0, 1.0]]);
        let message = SO3::from_matrix(cut).expect_err("digits were cut").to_string();
        assert!(message.contains("1.9") && message.contains("e-5"), "{message}");
        let (R, distance) = SO3::nearest(cut).expect("near a rotation");
        assert!(SO3::from_matrix(R.matrix()).is_ok() && distance < 1e-5);
        let nan = Mat3::identity() * f64::NAN;
        assert!(SO3::from_matrix(nan).is_err() && SO3::nearest(nan).is_err());
        let long = Mat3::from_rows([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]]);
        let error = SO3::nearest(long).expect_err("det = 3");
        assert_eq!((error.deviation, error.determinant), (8.0, 3.0));
    }

    #[test]
    fn left_jacobian_is_the_derivative_of_exp() {
        use crate::Dual;
        let (w, d) = ([0.3, -1.1, 0.7], [0.2, 0.5, -0.4]);
        let dual = Vec3([0, 1, 2].map(|i| Dual { value: w[i], derivative: d[i] }));
        let dR = SO3::exp(dual).matrix().map(|x| x.derivative);
        let R = SO3::exp(Vec3(w));
        let spatial = (dR * R.matrix().transpose()).vee(); // [δω] = dR Rᵀ
        assert!((spatial - SO3::left_jacobian(Vec3(w)) * Vec3(d)).norm() < 1e-15);
        let back = SO3::left_jacobian_inverse(Vec3(w)) * spatial;
        assert!((back - Vec3(d)).norm() < 1e-15);
    }

    #[test]
    fn rpy_turns_about_the_fixed_axes() {
        let about = |axis: usize, angle: f64| SO3::exp(Vec3([0, 1, 2].map(|i| if i == axis { angle } else { 0.0 })));
        let R = SO3::from_rpy(0.3, -0.5, 1.2);
        let E = (about(2, 1.2) * about(1, -0.5) * about(0, 0.3)).matrix() - R.matrix();
        assert!(E.x.norm() + E.y.norm() + E.z.norm() < 1e-15);
    }
}
