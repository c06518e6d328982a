//! A moving link in the screw normal form.

use crate::lie::SE3;
use crate::scalar::Scalar;
use crate::spatial::{JointAxis, SpatialInertia};
use core::marker::PhantomData;
use core::ops::Deref;

/// One moving link, with all that is fixed to it, in the frame whose z-axis is its joint's screw axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link<C> {
    /// Slot of the parent.
    pub parent: usize,
    /// Place in θ of this joint, or of the joint that it follows.
    pub q: usize,
    /// Place in θ̇, θ̈, τ.
    pub j: usize,
    /// A = (0, 0, a, 0, 0, b).
    pub A: JointAxis<C>,
    /// M_{i,i−1}: the parent's frame seen from this one when the joint is at 0.
    pub M: SE3<C>,
    /// 𝒢.
    pub G: SpatialInertia<C>,
    /// The joint's own variable is ratio · θ + offset; (1, 0) where it follows none.
    pub ratio: C,
    pub offset: C,
}

impl<C: Scalar> Link<C> {
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Link<U> {
        Link {
            parent: self.parent,
            q: self.q,
            j: self.j,
            A: JointAxis { a: f(self.A.a), b: f(self.A.b) },
            M: self.M.map(f),
            G: self.G.map(f),
            ratio: f(self.ratio),
            offset: f(self.offset),
        }
    }
}

/// A link, its constants as `S`, each where it is asked for: a kernel that holds all of them at once has no registers left.
#[derive(Clone, Copy)]
pub(crate) struct Lifted<'m, C, S> {
    link: &'m Link<C>,
    number: PhantomData<S>,
}

impl<'m, C, S> Lifted<'m, C, S> {
    #[inline(always)]
    pub fn new(link: &'m Link<C>) -> Self {
        Lifted { link, number: PhantomData }
    }
}

/// What of a link is no number.
impl<C, S> Deref for Lifted<'_, C, S> {
    type Target = Link<C>;
    #[inline(always)]
    fn deref(&self) -> &Link<C> {
        self.link
    }
}

impl<C: Scalar, S: Scalar + From<C>> Lifted<'_, C, S> {
    /// A.
    #[inline(always)]
    pub fn A(&self) -> JointAxis<S> {
        JointAxis { a: S::from(self.link.A.a), b: S::from(self.link.A.b) }
    }

    /// A for one unit of the source joint's rate.
    #[inline(always)]
    pub fn unit(&self) -> JointAxis<S> {
        let (A, ratio) = (self.A(), self.ratio());
        JointAxis { a: A.a * ratio, b: A.b * ratio }
    }

    /// 𝒢.
    #[inline(always)]
    pub fn G(&self) -> SpatialInertia<S> {
        self.link.G.map(S::from)
    }

    /// The joint's rate by its source joint's.
    #[inline(always)]
    pub fn ratio(&self) -> S {
        S::from(self.link.ratio)
    }

    /// The joint's own variable, q = ratio · θ + offset.
    #[inline(always)]
    fn own(&self, theta: &[S]) -> S {
        self.ratio().mul_add(theta[self.link.q], S::from(self.link.offset))
    }

    /// T_{i,i−1}(θ) = e^{−`[A]`q} M_{i,i−1}.
    #[inline(always)]
    pub fn transform(&self, theta: &[S]) -> SE3<S> {
        self.transform_with(self.sin_cos(theta), theta)
    }

    /// T_{i,i−1}(θ), given the sine and cosine of the joint's angle.
    #[inline(always)]
    pub fn transform_with(&self, sin_cos: (S, S), theta: &[S]) -> SE3<S> {
        self.A().transform(sin_cos, self.own(theta), self.link.M.map(S::from))
    }

    /// The sine and cosine of the joint's angle.
    #[inline(always)]
    pub fn sin_cos(&self, theta: &[S]) -> (S, S) {
        self.A().sin_cos(self.own(theta))
    }

    /// The joint's own rate, ratio · θ̇; likewise its acceleration.
    #[inline(always)]
    pub fn rate(&self, dtheta: &[S]) -> S {
        self.ratio() * dtheta[self.link.j]
    }
}
