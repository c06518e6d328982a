//! The pairs (r, s) of a joint's axis for the matrices of `dynamics/composite_bodies.rs`, in its link's own frame. Only
//! the angular part of s is kept, because its linear part is multiplied by 0. The axis is along z; its rate has no
//! component along z.

use crate::linalg::Vec3;
use crate::scalar::Scalar;
use crate::spatial::{AxisRate, CoriolisFactor, JointAxis, SpatialInertia, Twist, Wrench};

/// For ∂τ/∂θ: (Ä, Ȧ).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByTheta<S> {
    pub r: Twist<S>,
    /// Along x and y.
    pub s: [S; 2],
}

/// For ∂τ/∂θ̇: (D, A); for C: (`[ad_𝒱]` A, ½ A).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByRates<S> {
    pub r: AxisRate<S>,
    /// Along z.
    pub s: S,
}

impl<S: Scalar> ByTheta<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        ByTheta { r: Twist::zero(), s: [S::zero(); 2] }
    }

    /// 𝒢r + 𝓑s.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn column(self, G: SpatialInertia<S>, B: CoriolisFactor<S>) -> Wrench<S> {
        G * self.r + B * self.s
    }

    /// rᵀF + sᵀm.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn dot(self, F: Wrench<S>, m: Vec3<S>) -> S {
        let ([x, y], [u, v, _]) = (self.s, m.0);
        x.mul_add(u, y.mul_add(v, self.r.dot(F)))
    }
}

impl<S: Scalar> ByRates<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        ByRates { r: AxisRate::zero(), s: S::zero() }
    }

    /// 𝒢r + 𝓑s.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn column(self, G: SpatialInertia<S>, B: CoriolisFactor<S>) -> Wrench<S> {
        G * self.r + B * JointAxis { a: self.s, b: S::zero() }
    }

    /// rᵀF + sᵀm.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn dot(self, F: Wrench<S>, m: Vec3<S>) -> S {
        self.s.mul_add(m.0[2], self.r.dot(F))
    }
}
