//! The way of a wrench from a link to the base, in one of two kinds of coordinates.
//!
//! In each link's own frame an axis is along z, and of a wrench little is multiplied, but it is turned at every step. In the base's axes, about each
//! link's own origin, a step is a shift, but an axis is a general twist, and every link is turned once. Composite bodies stay in the links' own frames
//! either way, where they keep their digits.

use crate::lie::{SE3, SO3};
use crate::linalg::Vec3;
use crate::model::{Lifted, Model, Pair, Turned};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};

/// What the composite-body pass asks on the way from link i to the base.
pub(super) trait Path<S: Scalar> {
    /// A wrench that is given in link i's frame, as the way begins.
    fn taken(&self, i: usize, F: Wrench<S>) -> Wrench<S>;
    /// A moment likewise, which is the same about every origin.
    fn taken_moment(&self, i: usize, m: Vec3<S>) -> Vec3<S>;
    /// A wrench as it goes on from a link to its parent.
    fn carried(&self, link: usize, F: Wrench<S>) -> Wrench<S>;
    /// A moment likewise.
    fn carried_moment(&self, link: usize, m: Vec3<S>) -> Vec3<S>;
    /// A_kᵀF.
    fn force<C: Scalar>(&self, k: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>;
    /// (r, s) of axis k for the matrix q.
    fn pair(&self, q: usize, k: usize) -> Pair<S>;
}

/// Each link's own frame.
pub(super) struct LinkFrames<'w, S> {
    pub T: &'w [SE3<S>],
    pub pairs: [&'w [Pair<S>]; 2],
}

impl<S: Scalar> Path<S> for LinkFrames<'_, S> {
    #[inline(always)]
    fn taken(&self, _: usize, F: Wrench<S>) -> Wrench<S> {
        F
    }
    #[inline(always)]
    fn taken_moment(&self, _: usize, m: Vec3<S>) -> Vec3<S> {
        m
    }
    #[inline(always)]
    fn carried(&self, link: usize, F: Wrench<S>) -> Wrench<S> {
        self.T[link].Ad().transpose() * F
    }
    #[inline(always)]
    fn carried_moment(&self, link: usize, m: Vec3<S>) -> Vec3<S> {
        self.T[link].R.inverse_mul(m)
    }
    #[inline(always)]
    fn force<C: Scalar>(&self, _: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>,
    {
        link.A() * F
    }
    #[inline(always)]
    fn pair(&self, q: usize, k: usize) -> Pair<S> {
        self.pairs[q][k]
    }
}

/// The base's axes, about each link's own origin.
pub(super) struct BaseAxes<'w, S>(pub &'w [Turned<S>]);

impl<S: Scalar> Path<S> for BaseAxes<'_, S> {
    #[inline(always)]
    fn taken(&self, i: usize, F: Wrench<S>) -> Wrench<S> {
        let R = self.0[i].R;
        Wrench { m: R * F.m, f: R * F.f }
    }
    #[inline(always)]
    fn taken_moment(&self, i: usize, m: Vec3<S>) -> Vec3<S> {
        self.0[i].R * m
    }
    #[inline(always)]
    fn carried(&self, link: usize, F: Wrench<S>) -> Wrench<S> {
        Wrench { m: F.m + self.0[link].p.cross(F.f), f: F.f }
    }
    #[inline(always)]
    fn carried_moment(&self, _: usize, m: Vec3<S>) -> Vec3<S> {
        m
    }
    #[inline(always)]
    fn force<C: Scalar>(&self, k: usize, _: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>,
    {
        self.0[k].A.dot(F)
    }
    #[inline(always)]
    fn pair(&self, q: usize, k: usize) -> Pair<S> {
        self.0[k].pairs[q]
    }
}

/// Turns into the base's axes what the pass asks of links, from T_{i,i−1} and the first K lists of pairs.
#[cfg_attr(not(test), inline(always))]
pub(super) fn turn<const K: usize, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    T: &[SE3<S>],
    pairs: [&[Pair<S>]; 2],
    turned: &mut [Turned<S>],
) {
    turned[0].R = SO3::identity();
    for (i, link) in model.outward::<S>() {
        let R = turned[link.parent].R * T[i].R.inverse();
        let A = link.A().twist();
        // T is of the parent's frame seen from the link: its origin is −p from here
        let (p, A) = (-(R * T[i].p), Twist { w: R * A.w, v: R * A.v });
        let mut of_axis = [Pair::zero(); 2];
        for q in 0..K {
            let Pair { r, s } = pairs[q][i];
            of_axis[q] = Pair { r: Twist { w: R * r.w, v: R * r.v }, s: R * s };
        }
        turned[i] = Turned { R, p, A, pairs: of_axis };
    }
}
