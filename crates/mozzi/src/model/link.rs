//! A moving link in the screw normal form.

use crate::lie::{SE3, SO3};
use crate::linalg::{Mat3, Vec3};
use crate::scalar::Scalar;
use crate::spatial::{JointAxis, SpatialInertia};
use core::marker::PhantomData;
use core::ops::Deref;

/// How θ moves a link. A ball is modelled by three axes at one point, a free joint by six (three rotations, then three
/// translations). Each axis has a link of its own, and all but the last are massless, so that every pivot is a number
/// and every axis is along z. The axes are x, y, z of the joint's link in turn: the first link has the joint's link's
/// y, z, x as its axes, and each next link those of the one before, permuted in the same way.
///
/// These axes are **all carried by the joint's parent**: in 𝒱̇ = 𝒱̇_p + `[ad_𝒱]` 𝒱_J + 𝒱̇_J the joint's own part of 𝒱
/// cancels, so each of them adds `[ad_𝒱_p]` A θ̇, where 𝒱_p is the twist of the parent and not of the axis before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    /// The one axis of its joint: T = e^{−`[A]`q} M.
    Screw,
    /// The first axis of a ball, with its whole configuration: T = P R(q)ᵀ M.
    Ball,
    /// The first axis of a free joint: T = P T(q)⁻¹ M.
    Free,
    /// A further axis of the same joint as the link before: T = P.
    Next,
}

/// One moving link, with all links fixed to it, in the frame whose z-axis is its joint's screw axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link<C> {
    /// Slot of the parent.
    pub parent: usize,
    /// Index in θ of this joint, or of its source joint.
    pub q: usize,
    /// Index in θ̇, θ̈, τ.
    pub j: usize,
    /// The joint's screw axis, (0, 0, a, 0, 0, b).
    pub screw: JointAxis<C>,
    /// A, for one unit of the source joint's rate: the screw axis times the ratio.
    pub A: JointAxis<C>,
    /// How θ moves it.
    pub motion: Motion,
    /// True for the last axis of a joint, which carries the link's inertia; the links of the axes before it are
    /// massless.
    pub is_last: bool,
    /// M_{i,i−1}: the parent's frame relative to this one when the joint is at 0; for the first axis of a ball or a
    /// free joint, relative to the link's frame.
    pub M: SE3<C>,
    /// 𝒢.
    pub G: SpatialInertia<C>,
    /// The joint's own variable is ratio · θ + offset; (1, 0) for an independent joint.
    pub ratio: C,
    pub offset: C,
}

impl<C: Scalar> Link<C> {
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Link<U> {
        Link {
            parent: self.parent,
            q: self.q,
            j: self.j,
            screw: self.screw.map(f),
            A: self.A.map(f),
            motion: self.motion,
            is_last: self.is_last,
            M: self.M.map(f),
            G: self.G.map(f),
            ratio: f(self.ratio),
            offset: f(self.offset),
        }
    }
}

/// A link with constants of type `S`, each converted when it is used: a kernel that holds all of them at once runs out
/// of registers.
#[derive(Clone, Copy)]
pub(crate) struct Lifted<'m, C, S> {
    link: &'m Link<C>,
    /// The link's own, or [`Motion::Screw`] if that is known.
    motion: Motion,
    number: PhantomData<S>,
}

impl<'m, C, S> Lifted<'m, C, S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn new(link: &'m Link<C>) -> Self {
        Lifted { link, motion: link.motion, number: PhantomData }
    }

    /// With `ONE_AXIS`, which requires that all joints of the model have one axis, the compiler drops the code for ball
    /// and free joints (5 % faster).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn among<const ONE_AXIS: bool>(self) -> Self {
        if ONE_AXIS { Lifted { motion: Motion::Screw, ..self } } else { self }
    }
}

/// Access to the link's fields.
impl<C, S> Deref for Lifted<'_, C, S> {
    type Target = Link<C>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn deref(&self) -> &Link<C> {
        self.link
    }
}

impl<C: Scalar, S: Scalar + From<C>> Lifted<'_, C, S> {
    /// A.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn A(&self) -> JointAxis<S> {
        self.link.A.map(S::from)
    }

    /// The joint's screw axis.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn screw(&self) -> JointAxis<S> {
        self.link.screw.map(S::from)
    }

    /// 𝒢.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn G(&self) -> SpatialInertia<S> {
        self.link.G.map(S::from)
    }

    /// The joint's own variable, q = ratio · θ + offset.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn own(&self, theta: &[S]) -> S {
        S::from(self.link.ratio).mul_add(theta[self.link.q], S::from(self.link.offset))
    }

    /// T_{i,i−1}(θ) = e^{−`[A]`q} M_{i,i−1}.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transform(&self, theta: &[S]) -> SE3<S> {
        self.transform_with(self.sin_cos(theta), theta)
    }

    /// T_{i,i−1}(θ), given the sine and cosine of the joint's angle.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn transform_with(&self, sin_cos: (S, S), theta: &[S]) -> SE3<S> {
        let M = || self.link.M.map(S::from);
        match self.motion {
            Motion::Screw => self.screw().transform(sin_cos, self.own(theta), M()),
            Motion::Ball => {
                rarely();
                let [w, x, y, z] = core::array::from_fn(|k| theta[self.q + k]);
                let (R, M) = (SO3::from_quaternion(w, Vec3([x, y, z])).inverse(), M());
                in_turn(SE3 { R: R * M.R, p: R * M.p })
            }
            Motion::Free => {
                rarely();
                in_turn(SE3::from_pose(core::array::from_fn(|k| theta[self.q + k])).inverse() * M())
            }
            Motion::Next => {
                rarely();
                in_turn(SE3::identity())
            }
        }
    }

    /// The sine and cosine of the joint's angle; for an axis of a ball or a free joint, unused numbers, which cost less
    /// than a branch.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn sin_cos(&self, theta: &[S]) -> (S, S) {
        self.screw().sin_cos(self.own(theta))
    }

    /// True for a joint of one axis.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn has_one_axis(&self) -> bool {
        let is_one = self.motion == Motion::Screw;
        if !is_one {
            rarely();
        }
        is_one
    }

    /// True for every axis of a ball or a free joint except the first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn is_next(&self) -> bool {
        self.motion == Motion::Next
    }
}

/// Marks a branch as unlikely for the compiler.
#[cold]
#[cfg_attr(not(debug_assertions), inline(always))]
fn rarely() {}

/// P T: a configuration in a frame, expressed in the frame whose axes are its y, z and x.
#[cfg_attr(not(debug_assertions), inline(always))]
fn in_turn<S: Scalar>(T: SE3<S>) -> SE3<S> {
    let (R, [x, y, z]) = (T.R.matrix(), T.p.0);
    SE3 { R: SO3(Mat3 { x: R.y, y: R.z, z: R.x }), p: Vec3([y, z, x]) }
}
