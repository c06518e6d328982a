//! Twists: elements of se(3).

use super::Wrench;
use crate::linalg::{Mat3, Vec3, linear_space};
use crate::scalar::Scalar;

/// V = (ω, v), angular first: the velocity of a rigid body in some frame's coordinates; v is the velocity of the point
/// of the body that is at the frame's origin. Also a spatial acceleration V̇. rad/s and m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Twist<S = f64> {
    /// ω.
    pub w: Vec3<S>,
    /// v.
    pub v: Vec3<S>,
}
linear_space!(Twist { w, v });

impl<S: Scalar> Twist<S> {
    /// 0.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        Twist { w: Vec3::zero(), v: Vec3::zero() }
    }

    /// (0, v).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn linear(v: Vec3<S>) -> Self {
        Twist { w: Vec3::zero(), v }
    }

    /// From (ω, v) in one array, angular first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn from_array([a, b, c, x, y, z]: [S; 6]) -> Self {
        Twist { w: Vec3([a, b, c]), v: Vec3([x, y, z]) }
    }

    /// (ω, v) in one array, angular first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn to_array(self) -> [S; 6] {
        let ([a, b, c], [x, y, z]) = (self.w.0, self.v.0);
        [a, b, c, x, y, z]
    }

    /// (v, ω) in one array, **linear first**, as Pinocchio and MuJoCo order it.
    pub fn to_linear_first(self) -> [S; 6] {
        let ([a, b, c], [x, y, z]) = (self.w.0, self.v.0);
        [x, y, z, a, b, c]
    }

    /// From (v, ω), **linear first**.
    pub fn from_linear_first([x, y, z, a, b, c]: [S; 6]) -> Self {
        Twist { w: Vec3([a, b, c]), v: Vec3([x, y, z]) }
    }

    /// The power ωᵀm + vᵀf, in watts.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn dot(self, F: Wrench<S>) -> S {
        self.w.dot_add(F.m, self.v.dot(F.f))
    }

    /// `[V]`, the 4 × 4 matrix `[[[ω], v], [0, 0]]`, as rows.
    pub fn hat(self) -> [[S; 4]; 4] {
        let ([x, y, z], [a, b, c]) = (Mat3::hat(self.w).rows(), self.v.0);
        let row = |[i, j, k]: [S; 3], d| [i, j, k, d];
        [row(x, a), row(y, b), row(z, c), [S::zero(); 4]]
    }

    /// V of a 4 × 4 matrix `[V]`: the inverse of [`hat`](Self::hat).
    pub fn vee(m: [[S; 4]; 4]) -> Self {
        let row = |i: usize| [m[i][0], m[i][1], m[i][2]];
        Twist { w: Mat3::from_rows([row(0), row(1), row(2)]).vee(), v: Vec3([m[0][3], m[1][3], m[2][3]]) }
    }

    /// √(‖ω‖² + ‖v‖²), for tests and tolerances; it mixes units.
    pub fn norm(self) -> S {
        (self.w.dot(self.w) + self.v.dot(self.v)).sqrt()
    }

    /// The six unit twists: rotations about x, y, z, then translations along them.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn axes() -> [Self; 6] {
        let mut axes = [Self::zero(); 6];
        for k in 0..3 {
            axes[k].w.0[k] = S::one();
            axes[k + 3].v.0[k] = S::one();
        }
        axes
    }

    /// Each component by f.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U + Copy) -> Twist<U> {
        Twist { w: self.w.map(f), v: self.v.map(f) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_and_matrices_go_there_and_back() {
        let V = Twist::from_array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(Twist::from_array(V.to_array()), V);
        assert_eq!(V.to_linear_first(), [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
        assert_eq!(Twist::from_linear_first(V.to_linear_first()), V);
        assert_eq!(Twist::vee(V.hat()), V);
    }
}
