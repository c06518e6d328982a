//! Joint limits.

use super::description::{Limits, Source};
use super::{Freedom, Model, Place};
use crate::lie::SO3;
use crate::linalg::Vec3;
use alloc::vec;
use alloc::vec::Vec;

/// Lowest and highest value of each independent joint, −∞ and ∞ if there is no limit. A mimic joint's limits also
/// restrict its source joint. A ball's value is its angle from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// The joints' indices in θ and in θ̇.
    pub places: Vec<Place>,
    /// Lowest and highest values, rad or m.
    pub joints: Vec<[f64; 2]>,
    /// True if the values are angles (rad); false for prismatic joints (m).
    pub turns: Vec<bool>,
}

/// From this size on, a limit of position means none, as in SDFormat: files have no other number for a side without
/// limit.
pub const UNLIMITED: f64 = 1e16;

impl Limits {
    /// Lowest and highest position, −∞ and ∞ if there is none.
    pub fn bounds(&self) -> [f64; 2] {
        let [low, high] = self.position.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let low = if low > -UNLIMITED { low } else { f64::NEG_INFINITY };
        [low, if high < UNLIMITED { high } else { f64::INFINITY }]
    }
}

impl Bounds {
    /// The limits of a robot's joints.
    pub fn of(model: &Model) -> Self {
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        let mut joints = vec![free; model.joint_names().len()];
        for (joint, Source { joint: j, ratio, offset }) in model.moving_joints().zip(model.sources()) {
            if ratio == 0.0 {
                continue;
            }
            let [a, b] = joint.limits.bounds().map(|x| (x - offset) / ratio);
            let [low, high] = joints[j];
            let both = [low.max(a.min(b)), high.min(a.max(b))];
            // if the source joint's limits keep a mimic joint outside its own, the mimic joint's limits are ignored
            joints[j] = if both[0] <= both[1] { both } else { joints[j] };
        }
        let turns = model.joints().map(|joint| joint.kind.name() != "prismatic").collect();
        Bounds { places: model.places().to_vec(), joints, turns }
    }

    /// The largest speed and acceleration of each independent joint, ∞ if there is no limit: rad/s and rad/s², or m/s
    /// and m/s². A mimic joint's limits also restrict its source joint, but not those of 0, which files have where
    /// they mean none.
    pub fn of_rates(model: &Model) -> [Vec<f64>; 2] {
        let mut rates = [(); 2].map(|()| vec![f64::INFINITY; model.joint_names().len()]);
        for (joint, source) in model.moving_joints().zip(model.sources()) {
            for (most, limit) in rates.iter_mut().zip([joint.limits.velocity, joint.limits.acceleration]) {
                if let Some(limit) = limit.filter(|limit| joint.mimic.is_none() || *limit > 0.0) {
                    most[source.joint] = most[source.joint].min(limit / source.ratio.abs());
                }
            }
        }
        rates
    }

    /// The value of joint k that its limits bound: its position; for a ball, its angle from 0.
    ///
    /// # Panics
    /// On a θ of a wrong length, or if there is no joint k.
    pub fn value(&self, theta: &[f64], k: usize) -> f64 {
        self.places[k].bounded_value(theta)
    }

    /// Moves joint k to the limit that it is beyond, if there is one, and returns it.
    ///
    /// # Panics
    /// On a θ of a wrong length, or if there is no joint k.
    pub fn put_within(&self, theta: &mut [f64], k: usize) -> Option<f64> {
        let ([low, high], value) = (self.joints[k], self.value(theta, k));
        let limit = (!(low..=high).contains(&value)).then(|| value.clamp(low, high))?;
        self.places[k].put_at_limit(theta, limit);
        Some(limit)
    }
}

impl Place {
    /// The value that this joint's limits bound: its position; for a ball, its angle ‖φ‖ from 0.
    ///
    /// # Panics
    /// On a θ of a wrong length.
    pub fn bounded_value(&self, theta: &[f64]) -> f64 {
        match self.freedom {
            Freedom::Ball => self.rotation_vector(theta).norm(),
            _ => theta[self.q],
        }
    }

    /// The gradient n of [`bounded_value`](Self::bounded_value), whose rate is nᵀθ̇, with respect to the joint's
    /// velocities, padded with zeros: 1, or φ/‖φ‖ for a ball.
    ///
    /// # Panics
    /// On a θ of a wrong length.
    pub fn bounded_gradient(&self, theta: &[f64]) -> [f64; 3] {
        match self.freedom {
            Freedom::Ball => {
                let turn = self.rotation_vector(theta);
                (turn * (1.0 / turn.norm().max(f64::MIN_POSITIVE))).0
            }
            _ => [1.0, 0.0, 0.0],
        }
    }

    /// Moves the joint to a limit. A ball turns about its present axis and stops short of the limit by the rounding
    /// error of its quaternion, so that [`bounded_value`](Self::bounded_value) is within the limit.
    ///
    /// # Panics
    /// On a θ of a wrong length.
    pub fn put_at_limit(&self, theta: &mut [f64], limit: f64) {
        match self.freedom {
            Freedom::Ball => {
                let angle = limit * (1.0 - 8.0 * f64::EPSILON);
                let (w, v) = SO3::exp(Vec3(self.bounded_gradient(theta)) * angle).quaternion();
                let sign = theta[self.q].signum(); // q and −q are one rotation
                theta[self.positions()].copy_from_slice(&[w, v.0[0], v.0[1], v.0[2]].map(|x| sign * x));
            }
            _ => theta[self.q] = limit,
        }
    }

    /// φ of a ball with R = e^{`[φ]`}, ‖φ‖ ≤ π.
    fn rotation_vector(&self, theta: &[f64]) -> Vec3 {
        let [w, x, y, z] = [0, 1, 2, 3].map(|i| theta[self.q + i]);
        SO3::from_quaternion(w, Vec3([x, y, z])).log()
    }
}
