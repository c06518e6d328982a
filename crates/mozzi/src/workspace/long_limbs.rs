//! ∂θ̈ of long limbs. Everything is in the base's axes.

use crate::lie::SO3;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Columns that are processed together: two registers of four numbers.
pub(crate) const W: usize = 8;

/// Scratch memory for ∂θ̈ of a robot with long limbs, one entry for each slot.
#[derive(Clone, Debug)]
pub(crate) struct LongLimbs<S> {
    pub(crate) turned: Vec<Turned<S>>,
    /// The links as columns pass them.
    pub(crate) passed: Vec<Passed<S>>,
    /// The links as sources of their joints' columns.
    pub(crate) sources: Vec<Source<S>>,
    /// Several columns at each link that another limb branches off from; empty if there is none.
    pub(crate) at_forks: Vec<Columns<S>>,
    /// For each velocity its rows of the block of its ball or free joint, by θ and by θ̇; empty if there are none.
    pub(crate) blocks: Vec<[[S; 6]; 2]>,
}

impl<S: Scalar> LongLimbs<S> {
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let (slots, o) = (model.links.len() + 1, S::zero());
        let has_forks = model.structure.forks.contains(&true);
        LongLimbs {
            turned: vec![Turned::filled_with(o); slots],
            passed: vec![Passed::filled_with(o); slots],
            sources: vec![Source::filled_with(o); slots],
            at_forks: vec![Columns::filled_with(o); if has_forks { slots } else { 0 }],
            blocks: vec![[[o; 6]; 2]; if model.structure.of_one_axis { 0 } else { model.n() }],
        }
    }

    /// Sets every number.
    pub fn fill(&mut self, x: S) {
        self.turned.fill(Turned::filled_with(x));
        self.passed.fill(Passed::filled_with(x));
        self.sources.fill(Source::filled_with(x));
        self.at_forks.fill(Columns::filled_with(x));
        self.blocks.fill([[x; 6]; 2]);
    }
}

/// A link about its origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned<S> {
    /// R_0i.
    pub R: SO3<S>,
    /// From the link's origin to the parent's.
    pub p: Vec3<S>,
    pub A: Twist<S>,
    /// (r, s).
    pub by_theta: (Twist<S>, Vec3<S>),
    pub by_rates: (Twist<S>, Vec3<S>),
}

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

impl<S: Scalar> Turned<S> {
    pub fn filled_with(x: S) -> Self {
        let (V, p) = (Twist::from_array([x; 6]), Vec3([x; 3]));
        Turned { R: SO3::identity().map(|_: S| x), p, A: V, by_theta: (V, p), by_rates: (V, p) }
    }
}

impl<S: Scalar> Passed<S> {
    pub fn filled_with(x: S) -> Self {
        Passed { A: [x; 6], p: [x; 3], minus_U: [x; 6], minus_y: [x; 3], minus_Q: [[x; 6]; 2], minus_e: [x; 2] }
    }
}

impl<S: Scalar> Source<S> {
    pub fn filled_with(x: S) -> Self {
        Source { Phi: [[x; 6]; 6], B_hat: [Wrench::from_array([x; 6]); 3], a: [[x; 6]; 3], x }
    }
}

impl<S: Scalar> Columns<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn filled_with(x: S) -> Self {
        Columns { a: [[[x; W]; 6]; 3], s: [[[x; W]; 3]; 2] }
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
