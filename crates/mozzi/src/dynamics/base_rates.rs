//! The pairs (r, s) of a floating base's six axes: see `composite_bodies.rs`.

use crate::kinematics::base_pose;
use crate::linalg::Vec3;
use crate::model::{Environment, Model};
use crate::scalar::Scalar;
use crate::spatial::{CoriolisFactor, SpatialInertia, Twist, Wrench};
use crate::workspace::Workspace;

/// The pairs of the six axes e of a floating base, in its coordinates: r_e = `[ad_X]` e + `[ad_Y][ad_Y]` e and s_e =
/// σ e + `[ad_Y]` e.
#[derive(Clone, Copy)]
pub(super) struct BaseRates<S> {
    pub X: Twist<S>,
    /// None if it is 0.
    pub Y: Option<Twist<S>>,
    pub sigma: S,
}

impl<S: Scalar> BaseRates<S> {
    /// The rates for ∂τ/∂θ and for ∂τ/∂θ̇: the axes move with {s}.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn of_derivatives<C: Scalar>(
        model: &Model<C>,
        theta: &[S],
        environment: &Environment<S>,
        workspace: &Workspace<S>,
    ) -> [Self; 2]
    where
        S: From<C>,
    {
        let Ad = base_pose(model, theta).inverse().Ad();
        let (V_s, dV_s) = (Ad * environment.base_twist, Ad * environment.proper_base_acceleration());
        [
            BaseRates { X: dV_s, Y: Some(V_s), sigma: S::zero() },
            BaseRates { X: V_s + workspace.recursion.V[0], Y: None, sigma: S::one() },
        ]
    }

    /// (r_e, s_e).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn of(&self, e: Twist<S>) -> (Twist<S>, Vec3<S>) {
        let (r, s) = (self.X.ad() * e, e.w * self.sigma);
        match self.Y {
            None => (r, s),
            Some(Y) => {
                let Ye = Y.ad() * e;
                (r + Y.ad() * Ye, s + Ye.w)
            }
        }
    }

    /// 𝒢r_e + 𝓑s_e.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn column(&self, e: Twist<S>, G: SpatialInertia<S>, B: CoriolisFactor<S>) -> Wrench<S> {
        let (r, s) = self.of(e);
        G * r + B * s
    }

    /// The six numbers r_eᵀ F + s_eᵀ m.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn dot(&self, F: Wrench<S>, m: Vec3<S>) -> Wrench<S> {
        let row = self.X.ad().transpose() * F + Wrench { m: m * self.sigma, f: Vec3::zero() };
        match self.Y {
            None => row,
            Some(Y) => row + Y.ad().transpose() * (Y.ad().transpose() * F + Wrench { m, f: Vec3::zero() }),
        }
    }
}
