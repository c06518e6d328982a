//! The states at which everything is evaluated.

use mozzi::quantities::Query;
use mozzi::random::Random;
use mozzi::{Model, SE3, Twist, Vec3};

/// (θ, θ̇, θ̈, τ).
pub type State<'a> = [&'a [f64]; 4];

/// The parts of (θ, θ̇, θ̈, τ) on which a quantity depends.
pub fn inputs<T: Copy>(query: Query, [theta, dtheta, ddtheta, tau]: [T; 4]) -> Vec<T> {
    let input = |name| match name {
        "theta" => theta,
        "dtheta" => dtheta,
        "ddtheta" => ddtheta,
        _ => tau,
    };
    query.declaration().inputs.iter().map(|known| input(known.name)).collect()
}

/// K random states of a robot.
pub struct States {
    nq: usize,
    n: usize,
    /// θ, θ̇, θ̈, τ of each state, one after the other.
    numbers: Vec<f64>,
}

impl States {
    /// The number of states, for a robot that is not very long.
    pub const COUNT: usize = 256;

    /// This many states: angles all around the circle, with an arm's typical speeds and torques.
    pub fn new(model: &Model, count: usize) -> Self {
        let (mut random, nq, n) = (Random(1763), model.nq(), model.n());
        let mut numbers = Vec::new();
        for _ in 0..count {
            let start = numbers.len();
            for (size, length) in [(std::f64::consts::PI, nq), (2.0, n), (5.0, n), (20.0, n)] {
                numbers.extend(random.vector(length, size));
            }
            if model.is_floating() {
                let turn = Twist { w: Vec3(random.array()) * 2.0, v: Vec3(random.array()) };
                numbers[start..start + 7].copy_from_slice(&SE3::exp(turn).to_pose());
            }
        }
        States { nq, n, numbers }
    }

    /// The number of states.
    pub fn count(&self) -> usize {
        self.numbers.len() / (self.nq + 3 * self.n)
    }

    /// Each of them.
    pub fn iter(&self) -> impl Iterator<Item = State<'_>> {
        let (nq, n) = (self.nq, self.n);
        self.numbers.chunks_exact(nq + 3 * n).map(move |s| {
            let (theta, rest) = s.split_at(nq);
            [theta, &rest[..n], &rest[n..2 * n], &rest[2 * n..]]
        })
    }
}
