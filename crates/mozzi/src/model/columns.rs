//! Memory for the columns of ∂θ̈ in `dynamics/articulated_derivatives.rs`. Everything is in the base's axes.

use super::TOGETHER as W;
use crate::scalar::Scalar;
use crate::spatial::Wrench;

/// A link for the columns that pass it on their way outward. Products with these numbers are subtracted, so most have
/// their sign.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed<S> {
    /// About the link's origin.
    pub A: [S; 6],
    /// From the link's origin to the parent's.
    pub p: [S; 3],
    /// −U = −ĜA/d, about the parent's origin.
    pub minus_U: [S; 6],
    /// −y = −𝓑̂ᵀA/d.
    pub minus_y: [S; 3],
    /// −Q by θ and by θ̇, about the link's origin.
    pub minus_Q: [[S; 6]; 2],
    /// −e by θ and by θ̇: the joint's own stiffness and damping.
    pub minus_e: [S; 2],
}

/// A joint as the source of its three columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<S> {
    /// The acceleration of the link by a wrench on it, all joints being free.
    pub Phi: [[S; 6]; 6],
    /// The columns of 𝓑̂.
    pub B_hat: [Wrench<S>; 3],
    /// The link's a by a force at its joint, and its a + r by θ and by θ̇.
    pub a: [[S; 6]; 3],
    /// The entry of M⁻¹ on the diagonal.
    pub x: S,
}

/// W columns of each of the three matrices at one link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns<S> {
    /// a of the columns of M⁻¹, a + r of those by θ and by θ̇; angular first.
    pub a: [[[S; W]; 6]; 3],
    /// s of the columns by θ and by θ̇.
    pub s: [[[S; W]; 3]; 2],
}

impl<S: Scalar> Passed<S> {
    pub fn zero() -> Self {
        let o = S::zero();
        Passed { A: [o; 6], p: [o; 3], minus_U: [o; 6], minus_y: [o; 3], minus_Q: [[o; 6]; 2], minus_e: [o; 2] }
    }
}

impl<S: Scalar> Source<S> {
    pub fn zero() -> Self {
        let o = S::zero();
        Source { Phi: [[o; 6]; 6], B_hat: [Wrench::zero(); 3], a: [[o; 6]; 3], x: o }
    }
}

impl<S: Scalar> Columns<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        let o = [S::zero(); W];
        Columns { a: [[o; 6]; 3], s: [[o; 3]; 2] }
    }

    /// Copies the first `count` columns.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn copy_from(&mut self, of: &Self, count: usize) {
        for (to, of) in self.a.as_flattened_mut().iter_mut().zip(of.a.as_flattened()) {
            to[..count].copy_from_slice(&of[..count]);
        }
        for (to, of) in self.s.as_flattened_mut().iter_mut().zip(of.s.as_flattened()) {
            to[..count].copy_from_slice(&of[..count]);
        }
    }
}
