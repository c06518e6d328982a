//! Transport of a wrench from a link to the base, in one of two kinds of coordinates.
//!
//! In each link's own frame an axis is along z, so few components of a wrench are multiplied, but the wrench is rotated
//! at every step. In the base's axes, about each link's own origin, a step is a shift, but an axis is a general twist,
//! and every link is rotated once. Consecutive links are then processed together, about the origin of the last, the
//! nearest to the wrench's starting point. In both cases composite bodies stay in the links' own frames, where they are
//! most accurate.

use crate::lie::{SE3, SO3};
use crate::linalg::Vec3;
use crate::model::{ByRates, ByTheta, Lifted, Model, Row, Run, Runs, Turned};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};

/// The pairs of all axes, in the links' own frames.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'w, S> {
    pub by_theta: &'w [ByTheta<S>],
    pub by_rates: &'w [ByRates<S>],
}

/// The operations of the composite-body pass on the path from link i to the base.
pub(super) trait Path<S: Scalar> {
    /// Converts a wrench in link i's frame to the path's coordinates, at the start of the path.
    fn taken(&self, i: usize, F: Wrench<S>) -> Wrench<S>;
    /// The same for a moment without a force, which does not depend on the origin.
    fn taken_moment(&self, i: usize, m: Vec3<S>) -> Vec3<S>;
    /// Moves a wrench from a link to its parent.
    fn carried(&self, link: usize, F: Wrench<S>) -> Wrench<S>;
    /// The same for a moment without a force.
    fn carried_moment(&self, link: usize, m: Vec3<S>) -> Vec3<S>;
    /// A_kᵀF.
    fn force<C: Scalar>(&self, k: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>;
    /// rᵀ(𝒢ᶜA) + sᵀ(𝓑ᶜᵀA) of axis k, by θ.
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S;
    /// The same for the pairs by rates.
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S;
    /// The links that are processed together, of which k is the last.
    fn row(&self, k: usize) -> Option<(&Run, &Row<S>)>;
}

/// Coordinates in each link's own frame.
pub(super) struct LinkFrames<'w, S> {
    pub T: &'w [SE3<S>],
    pub pairs: Pairs<'w, S>,
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
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.pairs.by_theta[k].dot(GA, BtA)
    }
    #[inline(always)]
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.pairs.by_rates[k].dot(GA, BtA)
    }
    #[inline(always)]
    fn row(&self, _: usize) -> Option<(&Run, &Row<S>)> {
        None
    }
}

/// Coordinates in the base's axes, about each link's own origin.
pub(super) struct BaseAxes<'w, S> {
    pub links: &'w [Turned<S>],
    pub runs: &'w Runs,
    pub rows: &'w [Row<S>],
}

impl<S: Scalar> Path<S> for BaseAxes<'_, S> {
    #[inline(always)]
    fn taken(&self, i: usize, F: Wrench<S>) -> Wrench<S> {
        let R = self.links[i].R;
        Wrench { m: R * F.m, f: R * F.f }
    }
    #[inline(always)]
    fn taken_moment(&self, i: usize, m: Vec3<S>) -> Vec3<S> {
        self.links[i].R * m
    }
    #[inline(always)]
    fn carried(&self, link: usize, F: Wrench<S>) -> Wrench<S> {
        F.about(self.links[link].p)
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
        self.links[k].A.dot(F)
    }
    #[inline(always)]
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        let (r, s) = self.links[k].by_theta;
        r.dot(GA) + s.dot(BtA)
    }
    #[inline(always)]
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        let (r, s) = self.links[k].by_rates;
        r.dot(GA) + s.dot(BtA)
    }
    #[inline(always)]
    fn row(&self, k: usize) -> Option<(&Run, &Row<S>)> {
        let at = self.runs.ending_at(k)?;
        Some((&self.runs.list[at], &self.rows[at]))
    }
}

/// Rotates the links' quantities that the pass needs into the base's axes, from T_{i,i−1} and the lists of pairs that
/// are `taken`.
#[cfg_attr(not(test), inline(always))]
pub(super) fn turn<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    T: &[SE3<S>],
    pairs: Pairs<S>,
    taken: [bool; 2],
    turned: &mut [Turned<S>],
    rows: &mut [Row<S>],
) {
    turned[0].R = SO3::identity();
    for (i, link) in model.outward::<S>() {
        let R = turned[link.parent].R * T[i].R.inverse();
        let turn = |V: Twist<S>| Twist { w: R * V.w, v: R * V.v };
        let now = &mut turned[i];
        (now.R, now.p, now.A) = (R, R * T[i].p, turn(link.A().twist()));
        if taken[0] {
            let ByTheta { r, s: [x, y] } = pairs.by_theta[i];
            now.by_theta = (turn(r), R * Vec3([x, y, S::zero()]));
        }
        if taken[1] {
            let ByRates { r, s } = pairs.by_rates[i];
            now.by_rates = (turn(r.twist()), R * Vec3([S::zero(), S::zero(), s]));
        }
    }
    for (run, row) in model.structure.runs.list.iter().zip(rows) {
        row.gather(run, turned, taken);
    }
}
