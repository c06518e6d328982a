//! Articulated-body inertia: a symmetric map se(3) → se(3)*.

use super::{JointAxis, SpatialInertia, Twist, Wrench};
use crate::lie::Adjoint;
use crate::linalg::{Mat3, Skew, Sym3, Vec3, linear_space};
use crate::scalar::Scalar;
use core::ops::Mul;

/// `[[I, H], [Hᵀ, M]]`, 21 numbers: the wrench that a link needs for an acceleration while all joints beyond it are
/// free (Featherstone 2008, chapter 7).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ArticulatedInertia<S = f64> {
    /// Moment by angular acceleration.
    pub I: Sym3<S>,
    /// Moment by linear acceleration.
    pub H: Mat3<S>,
    /// Force by linear acceleration.
    pub M: Sym3<S>,
}
linear_space!(ArticulatedInertia { I, H, M });

impl<S: Scalar> From<SpatialInertia<S>> for ArticulatedInertia<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn from(G: SpatialInertia<S>) -> Self {
        ArticulatedInertia { I: G.I, H: Mat3::hat(G.mc), M: Sym3::diagonal(G.mass, G.mass, G.mass) }
    }
}

impl<S: Scalar> ArticulatedInertia<S> {
    /// `[Ad_T]`ᵀ Ĝ `[Ad_T]` + `to`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn congruence_add(self, Ad: Adjoint<S>, to: Self) -> Self {
        let (P, Rt) = (Skew(Ad.0.p), Ad.0.R.matrix().transpose());
        // [Ad] = [[1, 0], [P, 1]] diag(R, R): apply P, for which Pᵀ = −P, then rotate
        let H = Skew(-P.0).mul_add(self.M.to_mat3(), self.H);
        let I = Sym3::upper(H.mul_add_skew(P, self.H.mul_add_skew(P, self.I.to_mat3()).transpose()));
        ArticulatedInertia {
            I: I.congruence_add(Rt, to.I),
            H: (Rt * H).mul_add(Rt.transpose(), to.H),
            M: self.M.congruence_add(Rt, to.M),
        }
    }

    /// Ĝ V + `to`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn mul_add(self, V: Twist<S>, to: Wrench<S>) -> Wrench<S> {
        let (I, H, M) = (self.I.to_mat3(), self.H, self.M.to_mat3());
        let row = |I: Vec3<S>, H: Vec3<S>, to| I.dot_add(V.w, H.dot_add(V.v, to));
        let ([mx, my, mz], [fx, fy, fz], Ht) = (to.m.0, to.f.0, H.transpose());
        Wrench {
            m: Vec3([row(I.x, H.x, mx), row(I.y, H.y, my), row(I.z, H.z, mz)]),
            f: Vec3([row(Ht.x, M.x, fx), row(Ht.y, M.y, fy), row(Ht.z, M.z, fz)]),
        }
    }

    /// Ĝ − U Uᵀ/d, with 1/d given.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn minus_outer(self, U: Wrench<S>, one_over_d: S) -> Self {
        let k = -one_over_d;
        let [x, y, z] = (U.m * k).0;
        ArticulatedInertia {
            I: self.I.plus_outer(U.m, k),
            H: Mat3 { x: U.f.mul_add(x, self.H.x), y: U.f.mul_add(y, self.H.y), z: U.f.mul_add(z, self.H.z) },
            M: self.M.plus_outer(U.f, k),
        }
    }

    /// The 6 × 6 matrix, as rows, angular first.
    pub fn to_matrix(self) -> [[S; 6]; 6] {
        let row = |[a, b, c]: [S; 3], [x, y, z]: [S; 3]| [a, b, c, x, y, z];
        let ([i, j, k], H, Ht) = (self.I.to_mat3().rows(), self.H.rows(), self.H.transpose().rows());
        let [x, y, z] = self.M.to_mat3().rows();
        [row(i, H[0]), row(j, H[1]), row(k, H[2]), row(Ht[0], x), row(Ht[1], y), row(Ht[2], z)]
    }
}

impl<S: Scalar> Mul<Twist<S>> for ArticulatedInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: Twist<S>) -> Wrench<S> {
        self.mul_add(V, Wrench::zero())
    }
}

impl<S: Scalar> Mul<JointAxis<S>> for ArticulatedInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, A: JointAxis<S>) -> Wrench<S> {
        let (Hz, I, M) = (self.H.transpose(), self.I.to_mat3(), self.M.to_mat3());
        Wrench { m: I.z.mul_add(A.a, Hz.z * A.b), f: self.H.z.mul_add(A.a, M.z * A.b) }
    }
}

impl<S: Scalar> Mul<JointAxis<S>> for SpatialInertia<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, A: JointAxis<S>) -> Wrench<S> {
        let ([x, y, _], I, o) = (self.mc.0, self.I, S::zero());
        let (a, b) = (A.a, A.b);
        Wrench {
            m: crate::linalg::Vec3([y.mul_add(b, I.xz * a), I.yz.mul_add(a, -(x * b)), I.zz * a]),
            f: crate::linalg::Vec3([-(y * a), x * a, self.mass.mul_add(b, o)]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lie::SE3;
    use crate::testing::{inertia, twist, wrench};

    /// A general articulated inertia.
    fn articulated() -> ArticulatedInertia {
        ArticulatedInertia::from(inertia(1)) + ArticulatedInertia::from(inertia(2)).minus_outer(wrench(3), 0.25)
    }

    #[test]
    fn congruence_is_the_composition_of_maps() {
        let (G, Ad, V) = (articulated(), SE3::exp(twist(2)).Ad(), twist(3));
        let zero = ArticulatedInertia::from(SpatialInertia::zero());
        let composed = Ad.transpose() * (G * (Ad * V));
        assert!((G.congruence_add(Ad, zero) * V - composed).norm() < 1e-13);
        let G = inertia(7);
        let seen = ArticulatedInertia::from(G).congruence_add(Ad, zero) * V;
        assert!((G.congruence(Ad) * V - seen).norm() < 1e-13);
    }

    #[test]
    fn the_joint_axis_takes_columns() {
        let A = JointAxis { a: 0.8, b: 0.3 };
        let G = articulated();
        assert!((G * A - G * A.twist()).norm() < 1e-15);
        assert!((inertia(4) * A - inertia(4) * A.twist()).norm() < 1e-15);
    }

    #[test]
    fn the_matrix_is_the_map() {
        let (G, V) = (articulated(), twist(9));
        let product = G.to_matrix().map(|row| row.iter().zip(V.to_array()).map(|(g, v)| g * v).sum());
        assert!((G * V - Wrench::from_array(product)).norm() < 1e-13);
    }
}
