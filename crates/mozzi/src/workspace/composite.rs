//! Composite bodies, and the rates of the axes.

use super::{ByRates, ByTheta};
use crate::linalg::{Mat3, Sym3, Vec3};
use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::{AxisRate, CoriolisFactor, SpatialInertia, Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Memory for M, C, ∂τ, ∂θ̈ and products with ∂τ; one entry per slot.
#[derive(Clone, Debug)]
pub(crate) struct Composite<S> {
    /// 𝒢, then 𝒢ᶜ of the link and all links beyond it.
    pub G: Vec<SpatialInertia<S>>,
    /// 𝓑, then 𝓑ᶜ.
    pub B: Vec<CoriolisFactor<S>>,
    /// The pairs of ∂τ/∂θ.
    pub by_theta: Vec<ByTheta<S>>,
    /// The pairs of ∂τ/∂θ̇ or C.
    pub by_rates: Vec<ByRates<S>>,
    /// Q of products with derivatives.
    pub Q: Vec<Wrench<S>>,
    /// The wrench of the joints' accelerations at and beyond the link.
    pub dF: Vec<Wrench<S>>,
}

impl<S: Scalar> Composite<S> {
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let slots = model.links.len() + 1;
        Composite {
            G: vec![SpatialInertia::zero(); slots],
            B: vec![CoriolisFactor { K: Mat3::zero(), f: Vec3::zero() }; slots],
            by_theta: vec![ByTheta::zero(); slots],
            by_rates: vec![ByRates::zero(); slots],
            Q: vec![Wrench::zero(); slots],
            dF: vec![Wrench::zero(); slots],
        }
    }

    /// Sets every number.
    pub fn fill(&mut self, x: S) {
        let Composite { G, B, by_theta, by_rates, Q, dF } = self;
        let three = Vec3([x; 3]);
        G.fill(SpatialInertia { mass: x, mc: three, I: Sym3::zero().map(|_: S| x) });
        B.fill(CoriolisFactor { K: Mat3::zero().map(|_: S| x), f: three });
        by_theta.fill(ByTheta { r: Twist { w: three, v: three }, s: [x; 2] });
        by_rates.fill(ByRates { r: AxisRate { w: [x; 2], v: [x; 2] }, s: x });
        for list in [Q, dF] {
            list.fill(Wrench { m: three, f: three });
        }
    }
}
