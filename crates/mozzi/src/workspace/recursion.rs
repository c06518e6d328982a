//! The links' motions and wrenches.

use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Memory for the passes from the base to the tips and back; one entry per slot.
#[derive(Clone, Debug)]
pub(crate) struct Recursion<S> {
    /// Sine and cosine of the joint's angle.
    pub sin_cos: Vec<(S, S)>,
    /// T_{i,i−1}.
    pub T: Vec<SE3<S>>,
    /// 𝒱.
    pub V: Vec<Twist<S>>,
    /// 𝒱̇.
    pub dV: Vec<Twist<S>>,
    /// How a vector of rates moves the link.
    pub X: Vec<Twist<S>>,
    /// 𝓕.
    pub F: Vec<Wrench<S>>,
    /// 𝒱, 𝒱̇ and X of the parent of a ball or a free joint, in the frame of each of its axes.
    pub carrier: Vec<[Twist<S>; 3]>,
}

impl<S: Scalar> Recursion<S> {
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let slots = model.links.len() + 1;
        Recursion {
            sin_cos: vec![(S::zero(), S::zero()); slots],
            T: vec![SE3::identity(); slots],
            V: vec![Twist::zero(); slots],
            dV: vec![Twist::zero(); slots],
            X: vec![Twist::zero(); slots],
            F: vec![Wrench::zero(); slots],
            carrier: vec![[Twist::zero(); 3]; slots],
        }
    }

    /// Sets every number.
    pub fn fill(&mut self, x: S) {
        let Recursion { sin_cos, T, V, dV, X, F, carrier } = self;
        let twist = Twist { w: Vec3([x; 3]), v: Vec3([x; 3]) };
        sin_cos.fill((x, x));
        T.fill(SE3::identity().map(|_: S| x));
        for list in [V, dV, X] {
            list.fill(twist);
        }
        F.fill(Wrench { m: twist.w, f: twist.v });
        carrier.fill([twist; 3]);
    }
}
