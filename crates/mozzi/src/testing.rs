//! Random values for the tests.

use crate::lie::SE3;
use crate::linalg::{Sym3, Vec3};
use crate::spatial::{SpatialInertia, Twist, Wrench};

/// Numbers in [−1, 1) from a seed (Steele and Vigna's SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn array<const K: usize>(&mut self) -> [f64; K] {
        core::array::from_fn(|_| self.next())
    }
    pub fn vector(&mut self, n: usize, size: f64) -> alloc::vec::Vec<f64> {
        (0..n).map(|_| size * self.next()).collect()
    }
}

pub fn twist(seed: u64) -> Twist {
    Twist::from_array(Random(seed).array())
}

pub fn wrench(seed: u64) -> Wrench {
    Wrench::from_array(Random(seed + 1000).array())
}

/// A physical inertia, with its centre of mass off the origin and its principal axes off the frame's.
pub fn inertia(seed: u64) -> SpatialInertia {
    let mut random = Random(seed + 2000);
    let [a, b, c] = random.array().map(|x: f64| 0.1 + x * x);
    let turn = SE3::exp(Twist::from_array(random.array())).R.matrix();
    SpatialInertia::new(
        1.0 + 0.9 * random.next(),
        Vec3(random.array()),
        Sym3::diagonal(b + c, a + c, a + b).congruence(turn),
    )
}

/// The largest difference of two configurations' entries.
pub fn distance(a: SE3, b: SE3) -> f64 {
    let (a, b) = (a.to_matrix(), b.to_matrix());
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}
