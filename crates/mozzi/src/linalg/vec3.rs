//! Vectors of ℝ³.

use crate::scalar::{Real, Scalar, assign_ops};
use core::ops::{Add, Mul, Neg, Sub};

/// A vector of ℝ³.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Vec3<S = f64>(pub [S; 3]);

impl<S: Scalar> Vec3<S> {
    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        Vec3([S::zero(); 3])
    }

    /// Each component by f.
    #[inline(always)]
    pub fn map<U>(self, f: impl Fn(S) -> U) -> Vec3<U> {
        let [x, y, z] = self.0;
        Vec3([f(x), f(y), f(z)])
    }

    /// a·b.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        ax.mul_add(bx, ay.mul_add(by, az * bz))
    }

    /// a·b + c.
    #[inline(always)]
    pub(crate) fn dot_add(self, b: Self, c: S) -> S {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        ax.mul_add(bx, ay.mul_add(by, az.mul_add(bz, c)))
    }

    /// a × b.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Vec3([ay.mul_add(bz, -(az * by)), az.mul_add(bx, -(ax * bz)), ax.mul_add(by, -(ay * bx))])
    }

    /// a × b + c.
    #[inline(always)]
    pub fn cross_add(self, b: Self, c: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (self.0, b.0, c.0);
        Vec3([
            ay.mul_add(bz, (-az).mul_add(by, cx)),
            az.mul_add(bx, (-ax).mul_add(bz, cy)),
            ax.mul_add(by, (-ay).mul_add(bx, cz)),
        ])
    }

    /// k a + b.
    #[inline(always)]
    pub fn mul_add(self, k: S, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Vec3([ax.mul_add(k, bx), ay.mul_add(k, by), az.mul_add(k, bz)])
    }

    /// ‖a‖; squares must neither overflow nor underflow.
    pub fn norm(self) -> S {
        self.dot(self).sqrt()
    }
}

impl<S: Real> Vec3<S> {
    /// The largest |component|.
    pub fn max_abs(self) -> S {
        self.0.into_iter().fold(S::zero(), |m, x| if x.abs() > m { x.abs() } else { m })
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Vec3([ax + bx, ay + by, az + bz])
    }
}
impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Vec3([ax - bx, ay - by, az - bz])
    }
}
impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [x, y, z] = self.0;
        Vec3([-x, -y, -z])
    }
}
impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: S) -> Self {
        let [x, y, z] = self.0;
        Vec3([x * k, y * k, z * k])
    }
}
assign_ops!([S: Scalar] Vec3<S>);
