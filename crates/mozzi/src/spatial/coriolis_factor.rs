//! The velocity-dependent factor in the derivatives of a body's wrench.

use super::{JointAxis, SpatialInertia, Twist, Wrench};
use crate::lie::Adjoint;
use crate::linalg::{Mat3, Skew, Vec3, linear_space};
use crate::scalar::Scalar;
use core::ops::Mul;

/// 𝓑 = 𝒢̇ + H(𝒢𝒱) : se(3) → se(3)*, with 𝒢̇ = −𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 and H(P)A = −`[ad_A]`ᵀP. The first moment of 𝒢̇
/// is the linear momentum f, so that half of it cancels against H:
///
/// > 𝓑 = `[[K, 0], [−2[f], 0]]`, K = İ − `[m]`, with (m, f) = 𝒢𝒱
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoriolisFactor<S> {
    pub K: Mat3<S>,
    pub f: Vec3<S>,
}
linear_space!(CoriolisFactor { K, f });

impl<S: Scalar> CoriolisFactor<S> {
    /// 𝓑 of a body with the momentum P = 𝒢𝒱.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn new(G: SpatialInertia<S>, V: Twist<S>, P: Wrench<S>) -> Self {
        CoriolisFactor { K: G.rate(V).I.to_mat3() - Skew(P.m).to_mat3(), f: P.f }
    }

    /// 𝓑 about the point p, in the same axes: K + 2 `[p][f]`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn about(self, p: Vec3<S>) -> Self {
        CoriolisFactor { K: self.K + Skew(p) * Skew(self.f + self.f), f: self.f }
    }

    /// `[Ad_T]`ᵀ 𝓑 `[Ad_T]`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn congruence(self, Ad: Adjoint<S>) -> Self {
        let (R, about) = (Ad.0.R.matrix(), self.about(Ad.0.p));
        CoriolisFactor { K: R.transpose() * about.K * R, f: R.transpose_mul(self.f) }
    }

    /// 𝓑ᵀA, a moment without a force: Kᵀω + 2 f × v.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transpose_mul(self, A: JointAxis<S>) -> Vec3<S> {
        let ([x, y, z], [fx, fy, _], b) = (self.K.z.0, self.f.0, A.b + A.b);
        Vec3([A.a.mul_add(x, b * fy), A.a.mul_add(y, -(b * fx)), A.a * z])
    }
}

/// 𝓑ᵀX, a moment without a force, of a body with the twist 𝒱 and the linear momentum f. Its mass points dm at r move by
/// ṙ, and X would move them by x = X_v + X_ω × r, so 𝓑ᵀX = 2 ∫ ṙ × x dm, which is
///
/// > 2 (f × X_v + v × (X_ω × mc) − I y) + tr(I) y, y = ω × X_ω
///
/// with (ω × r) × (X_ω × r) = r rᵀy and ∫ r rᵀ dm = ½ tr(I) − I.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn coriolis_moment<S: Scalar>(G: SpatialInertia<S>, V: Twist<S>, f: Vec3<S>, X: Twist<S>) -> Vec3<S> {
    let y = V.w.cross(X.w);
    let half = f.cross_add(X.v, V.v.cross_add(X.w.cross(G.mc), -(G.I * y)));
    y.mul_add(G.I.trace(), half + half)
}

/// 𝓑A, from A's angular part: the linear part meets zeros.
impl<S: Scalar> Mul<Vec3<S>> for CoriolisFactor<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, w: Vec3<S>) -> Wrench<S> {
        Wrench { m: self.K * w, f: w.cross(self.f + self.f) }
    }
}

impl<S: Scalar> Mul<JointAxis<S>> for CoriolisFactor<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, A: JointAxis<S>) -> Wrench<S> {
        let ([_, _, x], [_, _, y], [_, _, z], [fx, fy, _], a) =
            (self.K.x.0, self.K.y.0, self.K.z.0, self.f.0, A.a + A.a);
        Wrench { m: Vec3([x, y, z]) * A.a, f: Vec3([-(a * fy), a * fx, S::zero()]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lie::SE3;
    use crate::testing::{inertia, twist};

    #[test]
    fn it_is_the_rate_of_the_inertia_and_the_bracket_of_the_momentum() {
        let (G, V, A, X) = (inertia(1), twist(1), twist(2), twist(3));
        let P = G * V;
        let B = CoriolisFactor::new(G, V, P);
        let defined = |A: Twist| -(G * (V.ad() * A)) - V.ad().transpose() * (G * A) - A.ad().transpose() * P;
        assert!((B * A.w - defined(A)).norm() < 1e-13);
        let A = JointAxis { a: 0.7, b: -0.3 };
        assert!((B * A - B * A.twist().w).norm() < 1e-15);
        assert!((B.transpose_mul(A).dot(X.w) - A.twist().dot(defined(X))).abs() < 1e-13);
        let moment = |X| coriolis_moment(G, V, P.f, X);
        assert!((moment(A.twist()) - B.transpose_mul(A)).norm() < 1e-13);
        for (X, Z) in [(V, X), (X, twist(4))] {
            assert!((moment(X).dot(Z.w) - X.dot(defined(Z))).abs() < 1e-13);
        }
        // about another point: 𝓑 from the body's inertia and twist there
        let p = Vec3([0.3, -0.2, 0.5]);
        let (G, V) = (G.about(p), SE3 { p: -p, ..SE3::identity() }.Ad() * V);
        let there = CoriolisFactor::new(G, V, G * V);
        assert!((B.about(p) * X.w - there * X.w).norm() < 1e-13);
        // and in other axes: `[Ad_T]`ᵀ𝓑`[Ad_T]`
        let T = SE3::exp(twist(4));
        assert!((B.congruence(T.Ad()) * X.w - T.Ad().transpose() * (B * (T.Ad() * X).w)).norm() < 1e-13);
    }
}
