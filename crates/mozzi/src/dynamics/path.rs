//! Transport of a wrench from a link to the base, in one of two kinds of coordinates.
//!
//! In each link's own frame an axis is along z, so few components of a wrench are multiplied, but the wrench is rotated
//! at every step. In the base's axes, about each link's own origin, a step is a shift, but an axis is a general twist,
//! and every link is rotated once. Consecutive links are then processed together, about the origin of the last, the
//! nearest to the wrench's starting point. In both cases composite bodies stay in the links' own frames, where they are
//! most accurate.

use crate::lie::{SE3, SO3};
use crate::linalg::Vec3;
use crate::model::{ByRates, ByTheta, Lifted, Model, Row, Run, Runs, TOGETHER, Turned};
use crate::scalar::{Four, FourAtOnce, Scalar};
use crate::spatial::{Twist, Wrench};

/// The pairs of all axes, in the links' own frames.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'w, S> {
    pub by_theta: &'w [ByTheta<S>],
    pub by_rates: &'w [ByRates<S>],
}

/// What moves from link j to the base: the forces of axis j, as seen from a link on the way.
#[derive(Clone, Copy)]
pub(super) struct Load<S> {
    /// 𝒢ᶜA_j: row j, and column j of M.
    pub GA: Wrench<S>,
    /// 𝓑ᶜᵀA_j, a moment without a force, which does not depend on the origin.
    pub BtA: Vec3<S>,
    /// Column j of the matrices by θ and by θ̇.
    pub of_theta: Wrench<S>,
    pub of_rates: Wrench<S>,
}

/// The operations of the composite-body pass on the path from link i to the base. Without closures: called more than
/// once, they would be functions of their own, compiled without the entry's instruction set.
pub(super) trait Path<S: Scalar> {
    /// A load in the path's coordinates.
    type Carried: Copy;
    /// At the start of the path, a load in link i's frame.
    fn taken(&self, i: usize, load: Load<S>) -> Self::Carried;
    /// Moved from a link to its parent.
    fn carried(&self, link: usize, load: Self::Carried) -> Self::Carried;
    fn load(&self, carried: Self::Carried) -> Load<S>;
    /// A_kᵀF.
    fn force<C: Scalar>(&self, k: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>;
    /// rᵀ(𝒢ᶜA) + sᵀ(𝓑ᶜᵀA) of axis k, by θ.
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S;
    /// The same for the pairs by rates.
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S;
    /// The links that are processed together, of which k is the last.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn row(&self, _: usize) -> Option<(&Run, &Row<S>)> {
        None
    }
    /// A_kᵀF of each link of a row.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn forces(&self, row: &Row<S>, F: Wrench<S>) -> [S; TOGETHER] {
        row.forces(None, F)
    }
    /// Moved past a row, to the point p.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn about(&self, _: Vec3<S>, load: Self::Carried) -> Self::Carried {
        load
    }
}

/// Coordinates in each link's own frame.
pub(super) struct LinkFrames<'w, S> {
    pub T: &'w [SE3<S>],
    pub pairs: Pairs<'w, S>,
}

impl<S: Scalar> Path<S> for LinkFrames<'_, S> {
    type Carried = Load<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn taken(&self, _: usize, load: Load<S>) -> Load<S> {
        load
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn carried(&self, link: usize, Load { GA, BtA, of_theta, of_rates }: Load<S>) -> Load<S> {
        let (T, Ad) = (&self.T[link], self.T[link].Ad().transpose());
        Load { GA: Ad * GA, BtA: T.R.inverse_mul(BtA), of_theta: Ad * of_theta, of_rates: Ad * of_rates }
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn load(&self, load: Load<S>) -> Load<S> {
        load
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn force<C: Scalar>(&self, _: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>,
    {
        link.A() * F
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.pairs.by_theta[k].dot(GA, BtA)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.pairs.by_rates[k].dot(GA, BtA)
    }
}

/// The same, the load's moments and forces side by side in registers of four.
pub(super) struct Abreast<'w, S> {
    pub frames: LinkFrames<'w, S>,
    pub at_once: FourAtOnce,
}

/// Moments and forces of 𝒢ᶜA, of the columns by θ̇ and by θ, and of 𝓑ᶜᵀA: a register each along x, y and z.
#[derive(Clone, Copy)]
pub(super) struct FourWrenches<S: Scalar> {
    m: [S::Four; 3],
    f: [S::Four; 3],
}

impl<S: Scalar> Abreast<'_, S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn four(&self, a: Vec3<S>, b: Vec3<S>, c: Vec3<S>, d: Vec3<S>) -> [S::Four; 3] {
        let ([ax, ay, az], [bx, by, bz], [cx, cy, cz], [dx, dy, dz]) = (a.0, b.0, c.0, d.0);
        [
            S::Four::new(self.at_once, [ax, bx, cx, dx]),
            S::Four::new(self.at_once, [ay, by, cy, dy]),
            S::Four::new(self.at_once, [az, bz, cz, dz]),
        ]
    }

    /// Rᵀx of four vectors.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn turned(&self, R: &SO3<S>, [x, y, z]: [S::Four; 3]) -> [S::Four; 3] {
        let ([a, b, c], o) = (R.matrix().rows(), S::Four::new(self.at_once, [S::zero(); 4]));
        [
            x.mul_add(a[0], y.mul_add(b[0], z.mul_add(c[0], o))),
            x.mul_add(a[1], y.mul_add(b[1], z.mul_add(c[1], o))),
            x.mul_add(a[2], y.mul_add(b[2], z.mul_add(c[2], o))),
        ]
    }
}

impl<S: Scalar> Path<S> for Abreast<'_, S> {
    type Carried = FourWrenches<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn taken(&self, _: usize, Load { GA, BtA, of_theta, of_rates }: Load<S>) -> FourWrenches<S> {
        FourWrenches {
            m: self.four(GA.m, of_rates.m, of_theta.m, BtA),
            f: self.four(GA.f, of_rates.f, of_theta.f, Vec3::zero()),
        }
    }
    /// Of each wrench m ↦ Rᵀ(m + f × p), f ↦ Rᵀf.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn carried(&self, link: usize, FourWrenches { m: [x, y, z], f: [u, v, w] }: FourWrenches<S>) -> FourWrenches<S> {
        let SE3 { R, p: Vec3([px, py, pz]) } = &self.frames.T[link];
        let x = v.mul_add(*pz, w.mul_add(-*py, x));
        let y = w.mul_add(*px, u.mul_add(-*pz, y));
        let z = u.mul_add(*py, v.mul_add(-*px, z));
        FourWrenches { m: self.turned(R, [x, y, z]), f: self.turned(R, [u, v, w]) }
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn load(&self, FourWrenches { m: [x, y, z], f: [u, v, w] }: FourWrenches<S>) -> Load<S> {
        let ([x, y, z], [u, v, w]) = ([x.numbers(), y.numbers(), z.numbers()], [u.numbers(), v.numbers(), w.numbers()]);
        Load {
            GA: Wrench { m: Vec3([x[0], y[0], z[0]]), f: Vec3([u[0], v[0], w[0]]) },
            of_rates: Wrench { m: Vec3([x[1], y[1], z[1]]), f: Vec3([u[1], v[1], w[1]]) },
            of_theta: Wrench { m: Vec3([x[2], y[2], z[2]]), f: Vec3([u[2], v[2], w[2]]) },
            BtA: Vec3([x[3], y[3], z[3]]),
        }
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn force<C: Scalar>(&self, k: usize, link: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>,
    {
        self.frames.force(k, link, F)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.frames.by_theta(k, GA, BtA)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        self.frames.by_rates(k, GA, BtA)
    }
}

/// Coordinates in the base's axes, about each link's own origin.
pub(super) struct BaseAxes<'w, S> {
    pub links: &'w [Turned<S>],
    pub runs: &'w Runs,
    pub rows: &'w [Row<S>],
    pub at_once: Option<FourAtOnce>,
}

impl<S: Scalar> Path<S> for BaseAxes<'_, S> {
    type Carried = Load<S>;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn taken(&self, i: usize, Load { GA, BtA, of_theta, of_rates }: Load<S>) -> Load<S> {
        let R = self.links[i].R;
        Load {
            GA: Wrench { m: R * GA.m, f: R * GA.f },
            BtA: R * BtA,
            of_theta: Wrench { m: R * of_theta.m, f: R * of_theta.f },
            of_rates: Wrench { m: R * of_rates.m, f: R * of_rates.f },
        }
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn carried(&self, link: usize, load: Load<S>) -> Load<S> {
        self.about(self.links[link].p, load)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn load(&self, load: Load<S>) -> Load<S> {
        load
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn about(&self, p: Vec3<S>, Load { GA, BtA, of_theta, of_rates }: Load<S>) -> Load<S> {
        Load { GA: GA.about(p), BtA, of_theta: of_theta.about(p), of_rates: of_rates.about(p) }
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn force<C: Scalar>(&self, k: usize, _: &Lifted<C, S>, F: Wrench<S>) -> S
    where
        S: From<C>,
    {
        self.links[k].A.dot(F)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_theta(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        let (r, s) = self.links[k].by_theta;
        r.dot(GA) + s.dot(BtA)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn by_rates(&self, k: usize, GA: Wrench<S>, BtA: Vec3<S>) -> S {
        let (r, s) = self.links[k].by_rates;
        r.dot(GA) + s.dot(BtA)
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn row(&self, k: usize) -> Option<(&Run, &Row<S>)> {
        let at = self.runs.ending_at(k)?;
        Some((&self.runs.list[at], &self.rows[at]))
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn forces(&self, row: &Row<S>, F: Wrench<S>) -> [S; TOGETHER] {
        row.forces(self.at_once, F)
    }
}

/// Rotates the links' quantities that the pass needs into the base's axes, from T_{i,i−1} and the lists of pairs that
/// are `taken`.
#[cfg_attr(not(debug_assertions), inline(always))]
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
