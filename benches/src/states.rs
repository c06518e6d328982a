//! The states at which everything is evaluated.

use crate::random::Random;
use mozzi::Model;

/// (θ, θ̇, θ̈, τ).
pub type State<'a> = [&'a [f64]; 4];

/// K random states of a robot.
pub struct States {
    n: usize,
    /// θ, θ̇, θ̈, τ of each state, one after the other.
    pub numbers: Vec<f64>,
}

impl States {
    /// How many.
    pub const COUNT: usize = 256;

    /// States all around the circle, at speeds and torques that an arm has.
    pub fn new(model: &Model) -> Self {
        let (mut random, n) = (Random(1763), model.n());
        let sizes = [std::f64::consts::PI, 2.0, 5.0, 20.0];
        let all = (0..Self::COUNT).flat_map(|_| sizes).flat_map(|size| vec![size; n]);
        States { n, numbers: all.map(|size| size * random.number()).collect() }
    }

    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = State<'_>> {
        let n = self.n;
        self.numbers.chunks_exact(4 * n).map(move |s| [&s[..n], &s[n..2 * n], &s[2 * n..3 * n], &s[3 * n..]])
    }
}
