//! States at random, the same on every machine.

use core::f64::consts::{FRAC_PI_2, PI};
use mozzi::Freedom;
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi::random::Random;

/// The kind of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Within the joints' limits, rates about 1.
    Ordinary,
    /// Angles at and next to multiples of π/2.
    RightAngles,
    /// Angles up to 10⁶.
    LargeAngles,
    /// Rates up to 10⁴.
    Fast,
    /// A floating base 1 km from {s}.
    Far,
}

/// θ, θ̇, θ̈, τ and w of many states.
#[derive(Debug)]
pub struct States {
    nq: usize,
    n: usize,
    tables: [Vec<f64>; 5],
}

impl States {
    /// This many states of a robot.
    pub fn new(model: &Model, kind: Kind, count: usize, seed: u64) -> Self {
        let (nq, n, first) = (model.nq(), model.n(), model.base().positions());
        let mut random = Random(seed);
        let mut theta = Vec::with_capacity(nq * count);
        for _ in 0..count {
            if first > 0 {
                let q: [f64; 4] = random.array();
                let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                theta.extend(q.map(|x| x / length));
                let size = if kind == Kind::Far { 1000.0 } else { 1.0 };
                theta.extend(random.array::<3>().map(|x| x + size));
            }
            for (joint, place) in model.joints().zip(model.places()) {
                if place.freedom != Freedom::One {
                    let q: [f64; 4] = random.array();
                    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                    theta.extend(q.map(|x| x / length));
                    theta.extend(random.vector(place.freedom.positions() - 4, 1.0));
                    continue;
                }
                let reach = if joint.kind.name() == "prismatic" { 0.5 } else { PI };
                let [low, high] = joint.limits.position.unwrap_or([-reach, reach]).map(|x| x.clamp(-reach, reach));
                let (low, high) = if low < high { (low, high) } else { (-reach, reach) };
                let x = random.next();
                let slides = joint.kind.name() == "prismatic";
                theta.push(match kind {
                    _ if slides => low + (high - low) * (0.5 + 0.5 * x),
                    Kind::RightAngles => {
                        let next = [0.0, 0.0, 1e-16, -3e-16, 1e-9, -1e-5][random.below(6)];
                        FRAC_PI_2 * (random.below(9) as f64 - 4.0) + next
                    }
                    Kind::LargeAngles => 1e6 * x,
                    _ => low + (high - low) * (0.5 + 0.5 * x),
                });
            }
        }
        let speed = if kind == Kind::Fast { 1e4 } else { 1.0 };
        let rates = [2.0, 5.0, 20.0].map(|size| random.vector(n * count, size * speed));
        let [dtheta, ddtheta, tau] = rates;
        let w = random.vector(6 * count, 2.0);
        States { nq, n, tables: [theta, dtheta, ddtheta, tau, w] }
    }

    /// The states rounded to `f32`.
    pub fn rounded(&self) -> Self {
        let round = |table: &Vec<f64>| table.iter().map(|&x| f64::from(x as f32)).collect();
        States { tables: self.tables.each_ref().map(round), ..*self }
    }

    /// The number of states.
    pub fn len(&self) -> usize {
        self.tables[0].len().checked_div(self.nq).unwrap_or(0)
    }

    /// True if there are no states.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// θ of a state.
    pub fn theta(&self, state: usize) -> &[f64] {
        &self.tables[0][state * self.nq..][..self.nq]
    }

    /// A quantity's inputs for a range of states, one table for each.
    pub fn inputs(&self, query: &Query, first: usize, count: usize) -> Vec<&[f64]> {
        let table = |name: &str| match name {
            "theta" => (0, self.nq),
            "dtheta" | "x" => (1, self.n),
            "ddtheta" => (2, self.n),
            "w" => (4, 6),
            _ => (3, self.n),
        };
        let inputs = query.declaration().inputs.iter().map(|input| table(input.name));
        inputs.map(|(k, width)| &self.tables[k][first * width..][..count * width]).collect()
    }

    /// θ̇, θ̈, τ of a state.
    pub fn rates(&self, state: usize) -> [&[f64]; 3] {
        [1, 2, 3].map(|k| &self.tables[k][state * self.n..][..self.n])
    }
}
