//! A moving link in the screw normal form.

use crate::lie::SE3;
use crate::scalar::Scalar;
use crate::spatial::{JointAxis, SpatialInertia};

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

    #[inline(always)]
    pub fn lift<S: Scalar + From<C>>(&self) -> Link<S> {
        Link {
            parent: self.parent,
            q: self.q,
            j: self.j,
            A: JointAxis { a: S::from(self.A.a), b: S::from(self.A.b) },
            M: self.M.map(S::from),
            G: self.G.map(S::from),
            ratio: S::from(self.ratio),
            offset: S::from(self.offset),
        }
    }

    /// The joint's own variable, q = ratio · θ + offset.
    #[inline(always)]
    fn own(&self, theta: &[C]) -> C {
        self.ratio.mul_add(theta[self.q], self.offset)
    }

    /// T_{i,i−1}(θ) = e^{−`[A]`q} M_{i,i−1}.
    #[inline(always)]
    pub fn transform(&self, theta: &[C]) -> SE3<C> {
        self.transform_with(self.sin_cos(theta), theta)
    }

    /// T_{i,i−1}(θ), given the sine and cosine of the joint's angle.
    #[inline(always)]
    pub fn transform_with(&self, sin_cos: (C, C), theta: &[C]) -> SE3<C> {
        self.A.transform(sin_cos, self.own(theta), self.M)
    }

    /// The sine and cosine of the joint's angle.
    #[inline(always)]
    pub fn sin_cos(&self, theta: &[C]) -> (C, C) {
        self.A.sin_cos(self.own(theta))
    }

    /// The joint's own rate, ratio · θ̇; likewise its acceleration.
    #[inline(always)]
    pub fn rate(&self, dtheta: &[C]) -> C {
        self.ratio * dtheta[self.j]
    }
}
