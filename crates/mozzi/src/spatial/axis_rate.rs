//! The rate of a joint's axis, which is along z: `[ad_V]` A = (x, y, 0, x', y', 0).

use super::joint_axis::VelocityProduct;
use super::{CoriolisFactor, SpatialInertia, Twist, Wrench};
use crate::lie::LieBracket;
use crate::linalg::Vec3;
use crate::scalar::Scalar;
use core::ops::{Add, AddAssign, Mul};

/// The four nonzero components; products with it skip the multiplications by its zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisRate<S> {
    pub w: [S; 2],
    pub v: [S; 2],
}

impl<S: Scalar> AxisRate<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        AxisRate { w: [S::zero(); 2], v: [S::zero(); 2] }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn twist(self) -> Twist<S> {
        let ([x, y], [u, v], o) = (self.w, self.v, S::zero());
        Twist { w: Vec3([x, y, o]), v: Vec3([u, v, o]) }
    }

    /// Its product with a wrench.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn dot(self, F: Wrench<S>) -> S {
        let ([x, y], [u, v], [mx, my, _], [fx, fy, _]) = (self.w, self.v, F.m.0, F.f.0);
        x.mul_add(mx, y.mul_add(my, u.mul_add(fx, v * fy)))
    }

    /// This times a rate, plus `to`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn mul_add(self, rate: S, to: Twist<S>) -> Twist<S> {
        let ([x, y], [u, v], [a, b, c], [d, e, f]) = (self.w, self.v, to.w.0, to.v.0);
        Twist {
            w: Vec3([x.mul_add(rate, a), y.mul_add(rate, b), c]),
            v: Vec3([u.mul_add(rate, d), v.mul_add(rate, e), f]),
        }
    }
}

impl<S: Scalar> VelocityProduct<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn rate(self) -> AxisRate<S> {
        let Twist { w: Vec3([x, y, _]), v: Vec3([u, v, _]) } = self.twist();
        AxisRate { w: [x, y], v: [u, v] }
    }
}

impl<S: Scalar> Add for AxisRate<S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(self, o: Self) -> Self {
        AxisRate { w: [self.w[0] + o.w[0], self.w[1] + o.w[1]], v: [self.v[0] + o.v[0], self.v[1] + o.v[1]] }
    }
}

impl<S: Scalar> AddAssign for AxisRate<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

/// `[ad_V]` times the rate of an axis.
impl<S: Scalar> Mul<AxisRate<S>> for LieBracket<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, r: AxisRate<S>) -> Twist<S> {
        let ([wx, wy, wz], [vx, vy, vz], [x, y], [u, v]) = (self.0.w.0, self.0.v.0, r.w, r.v);
        Twist {
            w: Vec3([-(wz * y), wz * x, wx.mul_add(y, -(wy * x))]),
            v: Vec3([
                vz.mul_add(-y, -(wz * v)),
                vz.mul_add(x, wz * u),
                vx.mul_add(y, (-vy).mul_add(x, wx.mul_add(v, -(wy * u)))),
            ]),
        }
    }
}

/// 𝒢 times the rate of an axis.
impl<S: Scalar> Mul<AxisRate<S>> for SpatialInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, r: AxisRate<S>) -> Wrench<S> {
        let ([cx, cy, cz], I, [x, y], [u, v]) = (self.mc.0, self.I, r.w, r.v);
        Wrench {
            m: Vec3([
                I.xx.mul_add(x, I.xy.mul_add(y, -(cz * v))),
                I.xy.mul_add(x, I.yy.mul_add(y, cz * u)),
                I.xz.mul_add(x, I.yz.mul_add(y, cx.mul_add(v, -(cy * u)))),
            ]),
            f: Vec3([self.mass.mul_add(u, y * cz), self.mass.mul_add(v, -(x * cz)), x.mul_add(cy, -(y * cx))]),
        }
    }
}

/// 𝓑 times the rate of an axis, given by its angular part.
impl<S: Scalar> Mul<[S; 2]> for CoriolisFactor<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, [x, y]: [S; 2]) -> Wrench<S> {
        let ([[a, b, _], [c, d, _], [e, g, _]], [fx, fy, fz]) =
            ([self.K.x.0, self.K.y.0, self.K.z.0], (self.f + self.f).0);
        Wrench {
            m: Vec3([a.mul_add(x, b * y), c.mul_add(x, d * y), e.mul_add(x, g * y)]),
            f: Vec3([y * fz, -(x * fz), x.mul_add(fy, -(y * fx))]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::JointAxis;
    use crate::testing::{inertia, twist, wrench};

    #[test]
    fn the_short_forms_equal_the_general_ones() {
        let (V, W, G, F) = (twist(1), twist(2), inertia(3), wrench(4));
        let (A, B) = (JointAxis { a: 0.7, b: -0.4 }, CoriolisFactor::new(G, W, G * W));
        let rate = (V.ad() * A).rate();
        let general = V.ad() * A.twist();
        assert!((rate.twist() - general).norm() < 1e-15);
        assert!(((rate + rate).twist() - general * 2.0).norm() < 1e-15);
        assert!((rate.mul_add(0.3, W) - (general * 0.3 + W)).norm() < 1e-15);
        assert!((rate.dot(F) - general.dot(F)).abs() < 1e-14);
        assert!((W.ad() * rate - W.ad() * general).norm() < 1e-14);
        assert!((G * rate - G * general).norm() < 1e-13);
        assert!((B * rate.w - B * general.w).norm() < 1e-13);
    }
}
