//! The screw axis of a joint in its link's normal form: along z, A = (0, 0, a, 0, 0, b).

use super::{Twist, Wrench};
use crate::lie::{LieBracket, SE3, SO3};
use crate::linalg::{Mat3, Vec3};
use crate::scalar::Scalar;
use core::ops::{Add, Mul};

/// A = (0, 0, a, 0, 0, b): revolute (1, 0), prismatic (0, 1), helical (1, pitch). No joint needs a case of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointAxis<S> {
    pub a: S,
    pub b: S,
}

/// A θ̇ = (0, 0, w, 0, 0, v).
#[derive(Clone, Copy)]
pub(crate) struct JointTwist<S> {
    w: S,
    v: S,
}

impl<S> JointAxis<S> {
    /// Each number by f.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U) -> JointAxis<U> {
        JointAxis { a: f(self.a), b: f(self.b) }
    }
}

impl<S: Scalar> JointAxis<S> {
    /// (sin aq, cos aq).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn sin_cos(self, q: S) -> (S, S) {
        (self.a * q).sin_cos()
    }

    /// e^{−`[A]`q} M: rotate M by −aq about z, given [`sin_cos`](Self::sin_cos), and translate it by −bq along z.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transform(self, (s, c): (S, S), q: S, M: SE3<S>) -> SE3<S> {
        let ([px, py, pz], R) = (M.p.0, M.R.matrix());
        SE3 {
            R: SO3(Mat3 { x: R.y.mul_add(s, R.x * c), y: R.x.mul_add(-s, R.y * c), z: R.z }),
            p: Vec3([py.mul_add(s, px * c), px.mul_add(-s, py * c), q.mul_add(-self.b, pz)]),
        }
    }

    /// `[ad_A]`ᵀF.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn ad_transpose(self, F: Wrench<S>) -> Wrench<S> {
        let ([mx, my, _], [fx, fy, _], o, JointAxis { a, b }) = (F.m.0, F.f.0, S::zero(), self);
        Wrench { m: Vec3([my.mul_add(a, fy * b), -mx.mul_add(a, fx * b), o]), f: Vec3([fy * a, -(fx * a), o]) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn twist(self) -> Twist<S> {
        let o = S::zero();
        Twist { w: Vec3([o, o, self.a]), v: Vec3([o, o, self.b]) }
    }
}

impl<S: Scalar> Mul<S> for JointAxis<S> {
    type Output = JointTwist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, rate: S) -> JointTwist<S> {
        JointTwist { w: self.a * rate, v: self.b * rate }
    }
}

/// AᵀF, the force or torque that the joint's motor feels.
impl<S: Scalar> Mul<Wrench<S>> for JointAxis<S> {
    type Output = S;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, F: Wrench<S>) -> S {
        let ([.., mz], [.., fz]) = (F.m.0, F.f.0);
        self.a.mul_add(mz, self.b * fz)
    }
}

impl<S: Scalar> Add<JointTwist<S>> for Twist<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(self, o: JointTwist<S>) -> Twist<S> {
        let ([x, y, z], [a, b, c]) = (self.w.0, self.v.0);
        Twist { w: Vec3([x, y, z + o.w]), v: Vec3([a, b, c + o.v]) }
    }
}

/// `[ad_V]` A θ̇, whose z-components are 0: not computed, nor added.
#[derive(Clone, Copy)]
pub(crate) struct VelocityProduct<S> {
    V: Twist<S>,
    A: JointTwist<S>,
}

impl<S: Scalar> VelocityProduct<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn twist(self) -> Twist<S> {
        let ([wx, wy, _], [vx, vy, _], o) = (self.V.w.0, self.V.v.0, S::zero());
        let JointTwist { w, v } = self.A;
        Twist { w: Vec3([wy * w, -(wx * w), o]), v: Vec3([vy.mul_add(w, wy * v), -(vx.mul_add(w, wx * v)), o]) }
    }
}

impl<S: Scalar> Mul<JointTwist<S>> for LieBracket<S> {
    type Output = VelocityProduct<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, A: JointTwist<S>) -> VelocityProduct<S> {
        VelocityProduct { V: self.0, A }
    }
}

impl<S: Scalar> Mul<JointAxis<S>> for LieBracket<S> {
    type Output = VelocityProduct<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, A: JointAxis<S>) -> VelocityProduct<S> {
        VelocityProduct { V: self.0, A: JointTwist { w: A.a, v: A.b } }
    }
}

impl<S: Scalar> Add<VelocityProduct<S>> for Twist<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn add(self, o: VelocityProduct<S>) -> Twist<S> {
        let ([wx, wy, _], [vx, vy, _], JointTwist { w, v }) = (o.V.w.0, o.V.v.0, o.A);
        let ([x, y, z], [a, b, c]) = (self.w.0, self.v.0);
        Twist {
            w: Vec3([wy.mul_add(w, x), (-wx).mul_add(w, y), z]),
            v: Vec3([vy.mul_add(w, wy.mul_add(v, a)), (-vx).mul_add(w, (-wx).mul_add(v, b)), c]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{distance, twist};

    #[test]
    fn the_short_forms_equal_the_general_ones() {
        let (V, M, q, F) = (twist(1), SE3::exp(twist(2)), 0.7, Wrench::from_array(twist(3).to_array()));
        for (a, b) in [(1.0, 0.0), (0.0, 1.0), (1.0, 0.3)] {
            let A = JointAxis { a, b };
            assert!(distance(A.transform(A.sin_cos(q), q, M), SE3::exp(A.twist() * -q) * M) < 1e-15);
            assert!(((V.ad() * (A * q)).twist() - V.ad() * (A.twist() * q)).norm() < 1e-15);
            assert!((V + A * q - (V + A.twist() * q)).norm() == 0.0);
            assert!(((V.ad() * A).twist() - V.ad() * A.twist()).norm() < 1e-15);
            assert!((A.ad_transpose(F) - A.twist().ad().transpose() * F).norm() < 1e-15);
        }
    }
}
