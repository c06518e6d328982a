//! The adjoint maps, each its own type: [Ad_T] and [ad_V] move twists, their transposes move wrenches.

use super::SE3;
use super::{Twist, Wrench};
use crate::scalar::Scalar;
use core::ops::Mul;

/// `[Ad_T]` : se(3) → se(3). With T = `T_sb`, V_s = `[Ad_T]` V_b (Modern Robotics 3.83).
#[derive(Clone, Copy, Debug)]
pub struct Adjoint<S = f64>(pub(crate) SE3<S>);

/// `[Ad_T]`ᵀ : se(3)* → se(3)*. With T = `T_sb`, F_b = `[Ad_T]`ᵀ F_s (Modern Robotics 3.95).
#[derive(Clone, Copy, Debug)]
pub struct AdjointTranspose<S = f64>(SE3<S>);

/// `[ad_V]` : se(3) → se(3), the Lie bracket with V (Modern Robotics 8.38).
#[derive(Clone, Copy, Debug)]
pub struct LieBracket<S = f64>(pub(crate) Twist<S>);

/// `[ad_V]`ᵀ : se(3)* → se(3)*.
#[derive(Clone, Copy, Debug)]
pub struct LieBracketTranspose<S = f64>(Twist<S>);

impl<S: Scalar> SE3<S> {
    /// `[Ad_T]`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn Ad(self) -> Adjoint<S> {
        Adjoint(self)
    }
}

impl<S: Scalar> Twist<S> {
    /// `[ad_V]`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn ad(self) -> LieBracket<S> {
        LieBracket(self)
    }
}

impl<S: Scalar> Adjoint<S> {
    /// `[Ad_T]`ᵀ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transpose(self) -> AdjointTranspose<S> {
        AdjointTranspose(self.0)
    }

    /// The 6 × 6 matrix, as rows: `[[R, 0], [[p]R, R]]`.
    pub fn to_matrix(self) -> [[S; 6]; 6] {
        columns(|e| self * e)
    }
}

impl<S: Scalar> AdjointTranspose<S> {
    /// `[Ad_T]`ᵀ F + `to`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn mul_add(self, F: Wrench<S>, to: Wrench<S>) -> Wrench<S> {
        let SE3 { R, p } = self.0;
        let R = R.matrix();
        Wrench { m: R.transpose_mul_add(F.f.cross_add(p, F.m), to.m), f: R.transpose_mul_add(F.f, to.f) }
    }
}

impl<S: Scalar> LieBracket<S> {
    /// `[ad_V]`ᵀ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transpose(self) -> LieBracketTranspose<S> {
        LieBracketTranspose(self.0)
    }

    /// The 6 × 6 matrix, as rows: `[[[ω], 0], [[v], [ω]]]`.
    pub fn to_matrix(self) -> [[S; 6]; 6] {
        columns(|e| self * e)
    }
}

/// The matrix of a linear map, from its columns.
fn columns<S: Scalar>(map: impl Fn(Twist<S>) -> Twist<S>) -> [[S; 6]; 6] {
    let mut rows = [[S::zero(); 6]; 6];
    for j in 0..6 {
        let mut e = [S::zero(); 6];
        e[j] = S::one();
        for (row, x) in rows.iter_mut().zip(map(Twist::from_array(e)).to_array()) {
            row[j] = x;
        }
    }
    rows
}

impl<S: Scalar> Mul<Twist<S>> for Adjoint<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: Twist<S>) -> Twist<S> {
        let SE3 { R, p } = self.0;
        let w = R * V.w;
        Twist { w, v: p.cross_add(w, R * V.v) }
    }
}

impl<S: Scalar> Mul<Wrench<S>> for AdjointTranspose<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, F: Wrench<S>) -> Wrench<S> {
        let SE3 { R, p } = self.0;
        Wrench { m: R.inverse_mul(F.f.cross_add(p, F.m)), f: R.inverse_mul(F.f) }
    }
}

impl<S: Scalar> Mul<Twist<S>> for LieBracket<S> {
    type Output = Twist<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, V: Twist<S>) -> Twist<S> {
        let Twist { w, v } = self.0;
        Twist { w: w.cross(V.w), v: v.cross_add(V.w, w.cross(V.v)) }
    }
}

impl<S: Scalar> Mul<Wrench<S>> for LieBracketTranspose<S> {
    type Output = Wrench<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn mul(self, F: Wrench<S>) -> Wrench<S> {
        let Twist { w, v } = self.0;
        Wrench { m: F.m.cross_add(w, F.f.cross(v)), f: F.f.cross(w) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{distance, twist, wrench};

    #[test]
    fn transposes_keep_power() {
        let (V, W, F) = (twist(1), twist(2), wrench(3));
        let T = SE3::exp(twist(4));
        assert!(((T.Ad() * V).dot(F) - V.dot(T.Ad().transpose() * F)).abs() < 1e-14);
        assert!(((W.ad() * V).dot(F) - V.dot(W.ad().transpose() * F)).abs() < 1e-14);
    }

    #[test]
    fn the_adjoint_is_conjugation_by_the_motion() {
        // T e^{[V]} T⁻¹ = e^{[Ad_T V]}
        let (T, V) = (SE3::exp(twist(4)), twist(1));
        assert!(distance(T * SE3::exp(V) * T.inverse(), SE3::exp(T.Ad() * V)) < 1e-14);
    }

    #[test]
    fn the_bracket_is_the_derivative_of_the_adjoint() {
        use crate::Dual;
        let (V, W) = (twist(1), twist(2));
        let dual = SE3::exp(V.map(|x| Dual { value: 0.0, derivative: x })).Ad() * W.map(Dual::constant);
        assert!((dual.map(|x| x.derivative) - V.ad() * W).norm() < 1e-14);
        assert!((V.ad() * V).norm() < 1e-15);
    }

    #[test]
    fn matrices_have_the_books_blocks() {
        let T: SE3 = SE3::translation([1.0, 2.0, 3.0]);
        assert_eq!(T.Ad().to_matrix()[3], [0.0, -3.0, 2.0, 1.0, 0.0, 0.0]);
        let V = Twist::from_array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(V.ad().to_matrix()[4], [6.0, 0.0, -4.0, 3.0, 0.0, -1.0]);
    }
}
