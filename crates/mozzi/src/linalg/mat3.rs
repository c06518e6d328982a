//! 3 × 3 matrices.

use super::{Skew, Vec3, linear_space};
use crate::scalar::{Real, Scalar};
use core::ops::Mul;

/// A 3 × 3 matrix, as its three rows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Mat3<S = f64> {
    /// First row.
    pub x: Vec3<S>,
    /// Second row.
    pub y: Vec3<S>,
    /// Third row.
    pub z: Vec3<S>,
}
linear_space!(Mat3 { x, y, z });

impl<S: Scalar> Mat3<S> {
    /// From rows.
    #[inline(always)]
    pub fn from_rows([x, y, z]: [[S; 3]; 3]) -> Self {
        Mat3 { x: Vec3(x), y: Vec3(y), z: Vec3(z) }
    }

    /// The rows.
    #[inline(always)]
    pub fn rows(self) -> [[S; 3]; 3] {
        [self.x.0, self.y.0, self.z.0]
    }

    /// I.
    #[inline(always)]
    pub fn identity() -> Self {
        let (o, i) = (S::zero(), S::one());
        Mat3::from_rows([[i, o, o], [o, i, o], [o, o, i]])
    }

    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        Mat3 { x: Vec3::zero(), y: Vec3::zero(), z: Vec3::zero() }
    }

    /// `[w]`, with `[w]` v = w × v.
    #[inline(always)]
    pub fn hat(w: Vec3<S>) -> Self {
        Skew(w).to_mat3()
    }

    /// w of the skew-symmetric part: `[w]` = (B − Bᵀ)/2.
    #[inline(always)]
    pub fn vee(self) -> Vec3<S> {
        let ([[_, xy, xz], [yx, _, yz], [zx, zy, _]], half) = (self.rows(), S::from_f64(0.5));
        Vec3([(zy - yz) * half, (xz - zx) * half, (yx - xy) * half])
    }

    /// Bᵀ.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = self.rows();
        Mat3::from_rows([[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]])
    }

    /// Bᵀv.
    #[inline(always)]
    pub fn transpose_mul(self, v: Vec3<S>) -> Vec3<S> {
        let [vx, vy, vz] = v.0;
        self.x.mul_add(vx, self.y.mul_add(vy, self.z * vz))
    }

    /// Bᵀv + c.
    #[inline(always)]
    pub(crate) fn transpose_mul_add(self, v: Vec3<S>, c: Vec3<S>) -> Vec3<S> {
        let [vx, vy, vz] = v.0;
        self.x.mul_add(vx, self.y.mul_add(vy, self.z.mul_add(vz, c)))
    }

    /// AB + C, with A = `self`.
    #[inline(always)]
    pub(crate) fn mul_add(self, B: Self, C: Self) -> Self {
        let row = |a, c| B.transpose_mul_add(a, c);
        Mat3 { x: row(self.x, C.x), y: row(self.y, C.y), z: row(self.z, C.z) }
    }

    /// A`[w]` + C, with A = `self`: row by row, rᵀ`[w]` = (r × w)ᵀ.
    #[inline(always)]
    pub(crate) fn mul_add_skew(self, w: Skew<S>, C: Self) -> Self {
        let row = |r: Vec3<S>, c| r.cross_add(w.0, c);
        Mat3 { x: row(self.x, C.x), y: row(self.y, C.y), z: row(self.z, C.z) }
    }

    /// Each entry by f.
    #[inline(always)]
    pub fn map<U>(self, f: impl Fn(S) -> U) -> Mat3<U> {
        Mat3 { x: self.x.map(&f), y: self.y.map(&f), z: self.z.map(&f) }
    }

    /// The sum of the diagonal.
    pub fn trace(self) -> S {
        let [[xx, ..], [_, yy, _], [.., zz]] = self.rows();
        xx + yy + zz
    }

    /// The determinant.
    pub fn determinant(self) -> S {
        self.x.dot(self.y.cross(self.z))
    }
}

impl<S: Real> Mat3<S> {
    /// The largest |entry|.
    pub fn max_abs(self) -> S {
        Vec3([self.x, self.y, self.z].map(Vec3::max_abs)).max_abs()
    }
}

impl<S: Scalar> Mul<Vec3<S>> for Mat3<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        Vec3([self.x.dot(v), self.y.dot(v), self.z.dot(v)])
    }
}

impl<S: Scalar> Mul for Mat3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Mat3 { x: o.transpose_mul(self.x), y: o.transpose_mul(self.y), z: o.transpose_mul(self.z) }
    }
}
