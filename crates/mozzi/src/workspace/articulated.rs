//! Articulated bodies.

use crate::linalg::{Mat3, Sym3, Vec3};
use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::{ArticulatedInertia, SpatialInertia, Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Memory for forward dynamics by articulated bodies; one entry per slot.
#[derive(Clone, Debug)]
pub(crate) struct Articulated<S> {
    /// The velocity-product acceleration.
    pub c: Vec<Twist<S>>,
    /// Ĝ.
    pub G_hat: Vec<ArticulatedInertia<S>>,
    /// ĜA/d.
    pub U: Vec<Wrench<S>>,
    /// One number for each velocity: (τ − f − Aᵀ𝓕)/d.
    pub u: Vec<S>,
}

impl<S: Scalar> Articulated<S> {
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let slots = model.links.len() + 1;
        Articulated {
            c: vec![Twist::zero(); slots],
            G_hat: vec![SpatialInertia::zero().into(); slots],
            U: vec![Wrench::zero(); slots],
            u: vec![S::zero(); model.n()],
        }
    }

    /// Sets every number.
    pub fn fill(&mut self, x: S) {
        let Articulated { c, G_hat, U, u } = self;
        let three = Vec3([x; 3]);
        c.fill(Twist { w: three, v: three });
        let I = Sym3::zero().map(|_: S| x);
        G_hat.fill(ArticulatedInertia { I, H: Mat3::zero().map(|_: S| x), M: I });
        U.fill(Wrench { m: three, f: three });
        u.fill(x);
    }
}
