//! Skew-symmetric 3 × 3 matrices.

use super::{Mat3, Vec3};
use crate::scalar::Scalar;
use core::ops::Mul;

/// `[w]`, with `[w]` v = w × v: products with it cost no multiplication by its zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Skew<S>(pub Vec3<S>);

impl<S: Scalar> Skew<S> {
    #[inline(always)]
    pub fn to_mat3(self) -> Mat3<S> {
        let ([x, y, z], o) = (self.0.0, S::zero());
        Mat3::from_rows([[o, -z, y], [z, o, -x], [-y, x, o]])
    }
}

impl<S: Scalar> Mul<Mat3<S>> for Skew<S> {
    type Output = Mat3<S>;
    #[inline(always)]
    fn mul(self, B: Mat3<S>) -> Mat3<S> {
        let [x, y, z] = self.0.0;
        Mat3 { x: B.z.mul_add(y, B.y * -z), y: B.x.mul_add(z, B.z * -x), z: B.y.mul_add(x, B.x * -y) }
    }
}

impl<S: Scalar> Skew<S> {
    /// `[w]` B + C.
    #[inline(always)]
    pub fn mul_add(self, B: Mat3<S>, C: Mat3<S>) -> Mat3<S> {
        let [x, y, z] = self.0.0;
        Mat3 {
            x: B.z.mul_add(y, B.y.mul_add(-z, C.x)),
            y: B.x.mul_add(z, B.z.mul_add(-x, C.y)),
            z: B.y.mul_add(x, B.x.mul_add(-y, C.z)),
        }
    }
}

/// Row by row, rᵀ`[w]` = (r × w)ᵀ.
impl<S: Scalar> Mul<Skew<S>> for Mat3<S> {
    type Output = Mat3<S>;
    #[inline(always)]
    fn mul(self, W: Skew<S>) -> Mat3<S> {
        Mat3 { x: self.x.cross(W.0), y: self.y.cross(W.0), z: self.z.cross(W.0) }
    }
}

/// `[a]``[b]` = baᵀ − (aᵀb) I.
impl<S: Scalar> Mul for Skew<S> {
    type Output = Mat3<S>;
    #[inline(always)]
    fn mul(self, B: Self) -> Mat3<S> {
        let ([x, y, z], [a, b, c]) = (self.0.0, B.0.0);
        let diagonal = |p: S, q: S, r: S, s: S| -p.mul_add(q, r * s);
        Mat3::from_rows([
            [diagonal(y, b, z, c), a * y, a * z],
            [b * x, diagonal(x, a, z, c), b * z],
            [c * x, c * y, diagonal(x, a, y, b)],
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_equal_those_of_full_matrices() {
        let (a, b) = (Skew(Vec3([1.0, -2.0, 3.0])), Skew(Vec3([0.5, 4.0, -1.0])));
        let B = Mat3::from_rows([[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0], [7.0, 8.0, -9.0]]);
        assert_eq!(a * B, a.to_mat3() * B);
        assert_eq!(B * a, B * a.to_mat3());
        assert_eq!(a * b, a.to_mat3() * b.to_mat3());
    }
}
