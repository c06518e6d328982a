//! Memory for one evaluation.

use super::{ByRates, ByTheta, Columns, Model, Passed, Row, Source, Turned};
use crate::lie::SE3;
use crate::linalg::{Mat3, Vec3};
use crate::scalar::Scalar;
use crate::spatial::{ArticulatedInertia, AxisRate, CoriolisFactor, SpatialInertia, Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Scratch memory for the kernels; nothing in it survives a call. Slot 0 is the base, slot i moving link i.
#[derive(Clone, Debug)]
pub struct Workspace<S = f64> {
    /// Sine and cosine of each joint's angle.
    pub(crate) sin_cos: Vec<(S, S)>,
    /// T_{i,i−1}.
    pub(crate) T: Vec<SE3<S>>,
    /// The slots between a frame and the base.
    pub(crate) path: Vec<usize>,
    pub(crate) V: Vec<Twist<S>>,
    pub(crate) dV: Vec<Twist<S>>,
    /// 𝒱, 𝒱̇ and X of the parent of a ball or a free joint, in the frame of each of its axes.
    pub(crate) carrier: Vec<[Twist<S>; 3]>,
    /// How a vector of rates moves each link.
    pub(crate) X: Vec<Twist<S>>,
    pub(crate) F: Vec<Wrench<S>>,
    /// The pairs of ∂τ/∂θ.
    pub(crate) by_theta: Vec<ByTheta<S>>,
    /// The pairs of ∂τ/∂θ̇ or C.
    pub(crate) by_rates: Vec<ByRates<S>>,
    /// Links in the base's axes; empty unless the robot is deep.
    pub(crate) turned: Vec<Turned<S>>,
    /// Runs of consecutive links; empty unless the robot is deep.
    pub(crate) rows: Vec<Row<S>>,
    /// Composite inertia 𝒢ᶜ.
    pub(crate) G_c: Vec<SpatialInertia<S>>,
    /// 𝓑 of the composite bodies.
    pub(crate) B: Vec<CoriolisFactor<S>>,
    /// Articulated inertia Ĝ.
    pub(crate) G_hat: Vec<ArticulatedInertia<S>>,
    /// ĜA.
    pub(crate) U: Vec<Wrench<S>>,
    /// Of ∂θ̈ by articulated bodies, else empty: the links as columns pass them, and as their sources.
    pub(crate) passed: Vec<Passed<S>>,
    pub(crate) sources: Vec<Source<S>>,
    /// Several columns at each link that another limb branches off from; empty if there is none.
    pub(crate) at_forks: Vec<Columns<S>>,
    /// Rows of the blocks of balls and free joints, by θ and by θ̇; empty if there are none.
    pub(crate) blocks: Vec<[[S; 6]; 2]>,
    /// One number for each joint.
    pub(crate) u: Vec<S>,
    /// The pivots of the last solve, for the caller that can compare numbers.
    pub(crate) pivots: Vec<S>,
    /// n zeros or a right-hand side.
    pub(crate) vector: Vec<S>,
    /// n × n for robots with mimic joints; else empty, and filled on demand by the caller.
    pub(crate) matrix: Vec<S>,
}

impl<S: Scalar> Workspace<S> {
    /// Memory for this model: O(n), and n × n more for robots with mimic joints.
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let (slots, n) = (model.links.len() + 1, model.n());
        let o = S::zero();
        let structure = &model.structure;
        let solves = |count: usize, needed: bool| if structure.solves_by_bodies && needed { count } else { 0 };
        Workspace {
            sin_cos: vec![(o, o); slots],
            T: vec![SE3::identity(); slots],
            path: Vec::with_capacity(slots),
            V: vec![Twist::zero(); slots],
            dV: vec![Twist::zero(); slots],
            carrier: vec![[Twist::zero(); 3]; slots],
            X: vec![Twist::zero(); slots],
            F: vec![Wrench::zero(); slots],
            by_theta: vec![ByTheta::zero(); slots],
            by_rates: vec![ByRates::zero(); slots],
            turned: if model.structure.is_deep { vec![Turned::zero(); slots] } else { Vec::new() },
            rows: vec![Row::zero(); model.structure.runs.list.len()],
            G_c: vec![SpatialInertia::zero(); slots],
            B: vec![CoriolisFactor { K: Mat3::zero(), f: Vec3::zero() }; slots],
            G_hat: vec![SpatialInertia::zero().into(); slots],
            U: vec![Wrench::zero(); slots],
            passed: vec![Passed::zero(); solves(slots, true)],
            sources: vec![Source::zero(); solves(slots, true)],
            at_forks: vec![Columns::zero(); solves(slots, structure.forks.contains(&true))],
            blocks: vec![[[o; 6]; 2]; solves(n, !structure.of_one_axis)],
            u: vec![o; slots],
            pivots: vec![o; n],
            vector: vec![o; n],
            matrix: if model.solves_by_mass_matrix() { vec![o; n * n] } else { Vec::new() },
        }
    }

    /// The pivots of the last forward dynamics or its derivatives, one per velocity. [`Pivots`](super::Pivots) judges
    /// them: a kernel cannot compare numbers, the methods of [`Model`] can.
    pub fn pivots(&self) -> &[S] {
        &self.pivots
    }

    /// Sets every number to NaN, to test that results do not depend on old contents.
    pub fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        let (V, F, T) = (Twist::from_array([nan; 6]), Wrench::from_array([nan; 6]), SE3::identity().map(|_: S| nan));
        let G = SpatialInertia { mass: nan, mc: Vec3([nan; 3]), I: crate::Sym3::zero().map(|_: S| nan) };
        self.sin_cos.fill((nan, nan));
        self.T.fill(T);
        self.V.fill(V);
        self.dV.fill(V);
        self.X.fill(V);
        self.carrier.fill([V; 3]);
        self.F.fill(F);
        self.U.fill(F);
        self.by_theta.fill(ByTheta { r: V, s: [nan; 2] });
        self.by_rates.fill(ByRates { r: AxisRate { w: [nan; 2], v: [nan; 2] }, s: nan });
        self.G_c.fill(G);
        self.B.fill(CoriolisFactor { K: Mat3::zero().map(|_: S| nan), f: V.v });
        self.G_hat.fill(G.into());
        for list in [&mut self.u, &mut self.pivots, &mut self.vector, &mut self.matrix] {
            list.fill(nan);
        }
    }
}
