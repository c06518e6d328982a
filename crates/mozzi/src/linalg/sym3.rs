//! Symmetric 3 × 3 matrices.

use super::{Mat3, Vec3, linear_space};
use crate::scalar::Scalar;
use core::ops::Mul;

/// A symmetric 3 × 3 matrix, as its upper triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
#[allow(missing_docs)] // the six entries
pub struct Sym3<S = f64> {
    pub xx: S,
    pub xy: S,
    pub xz: S,
    pub yy: S,
    pub yz: S,
    pub zz: S,
}
linear_space!(Sym3 { xx, xy, xz, yy, yz, zz });

impl<S: Scalar> Sym3<S> {
    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        let o = S::zero();
        Sym3 { xx: o, xy: o, xz: o, yy: o, yz: o, zz: o }
    }

    /// diag(x, y, z).
    #[inline(always)]
    pub fn diagonal(x: S, y: S, z: S) -> Self {
        Sym3 { xx: x, yy: y, zz: z, ..Sym3::zero() }
    }

    /// k aaᵀ.
    #[inline(always)]
    pub fn outer(a: Vec3<S>, k: S) -> Self {
        Sym3::zero().plus_outer(a, k)
    }

    /// S + k aaᵀ.
    #[inline(always)]
    pub(crate) fn plus_outer(self, a: Vec3<S>, k: S) -> Self {
        let [x, y, z] = a.0;
        let [kx, ky, kz] = (a * k).0;
        Sym3 {
            xx: kx.mul_add(x, self.xx),
            xy: kx.mul_add(y, self.xy),
            xz: kx.mul_add(z, self.xz),
            yy: ky.mul_add(y, self.yy),
            yz: ky.mul_add(z, self.yz),
            zz: kz.mul_add(z, self.zz),
        }
    }

    /// (B + Bᵀ)/2.
    #[inline(always)]
    pub fn symmetric_part(b: Mat3<S>) -> Self {
        let ([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]], half) = (b.rows(), S::from_f64(0.5));
        Sym3 { xx, yy, zz, xy: (xy + yx) * half, xz: (xz + zx) * half, yz: (yz + zy) * half }
    }

    /// The upper triangle of B, where B is known to be symmetric.
    #[inline(always)]
    pub(crate) fn upper(b: Mat3<S>) -> Self {
        let [[xx, xy, xz], [_, yy, yz], [.., zz]] = b.rows();
        Sym3 { xx, xy, xz, yy, yz, zz }
    }

    /// As a full matrix.
    #[inline(always)]
    pub fn to_mat3(self) -> Mat3<S> {
        let Sym3 { xx, xy, xz, yy, yz, zz } = self;
        Mat3::from_rows([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    }

    /// Each entry by f.
    #[inline(always)]
    pub fn map<U>(self, f: impl Fn(S) -> U) -> Sym3<U> {
        let Sym3 { xx, xy, xz, yy, yz, zz } = self;
        Sym3 { xx: f(xx), xy: f(xy), xz: f(xz), yy: f(yy), yz: f(yz), zz: f(zz) }
    }

    /// The sum of the diagonal.
    pub fn trace(self) -> S {
        self.xx + self.yy + self.zz
    }

    /// R S Rᵀ; for the upper triangle alone.
    #[inline(always)]
    pub fn congruence(self, R: Mat3<S>) -> Self {
        self.congruence_add(R, Sym3::zero())
    }

    /// R S Rᵀ + C.
    #[inline(always)]
    pub(crate) fn congruence_add(self, R: Mat3<S>, C: Self) -> Self {
        let RS = R * self.to_mat3();
        Sym3 {
            xx: RS.x.dot_add(R.x, C.xx),
            xy: RS.x.dot_add(R.y, C.xy),
            xz: RS.x.dot_add(R.z, C.xz),
            yy: RS.y.dot_add(R.y, C.yy),
            yz: RS.y.dot_add(R.z, C.yz),
            zz: RS.z.dot_add(R.z, C.zz),
        }
    }
}

impl<S: Scalar> Mul<Vec3<S>> for Sym3<S> {
    type Output = Vec3<S>;
    #[inline(always)]
    fn mul(self, v: Vec3<S>) -> Vec3<S> {
        self.to_mat3() * v
    }
}
