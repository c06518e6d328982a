//! Numbers that are the same on every machine.

use crate::lie::SE3;
use crate::model::{Freedom, Model};
use crate::spatial::Twist;
use alloc::vec::Vec;

/// Uniform random numbers from a seed (Steele, Lea and Flood's SplitMix64).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [−1, 1).
    #[allow(clippy::should_implement_trait)] // no iterator: it never ends
    pub fn next(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A whole number below n.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() >> 16) as usize % n
    }

    /// K numbers in [−1, 1).
    pub fn array<const K: usize>(&mut self) -> [f64; K] {
        core::array::from_fn(|_| self.next())
    }

    /// n numbers in [−size, size).
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.next()).collect()
    }
}

/// A random state (θ, θ̇, θ̈) of a model.
pub fn state(model: &Model, seed: u64) -> [Vec<f64>; 3] {
    let mut random = Random(seed + 4000);
    let mut theta = random.vector(model.nq(), 3.0);
    for place in model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One) {
        let pose = SE3::exp(Twist::from_array(random.array()) * 2.0).to_pose();
        theta[place.positions()].copy_from_slice(&pose[..place.freedom.positions()]);
    }
    [theta, random.vector(model.n(), 2.0), random.vector(model.n(), 5.0)]
}
