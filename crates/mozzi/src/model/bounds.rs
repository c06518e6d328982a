//! How far the joints may go.

use super::description::Source;
use super::{Freedom, Model, Place};
use crate::lie::SO3;
use crate::linalg::Vec3;
use alloc::vec;
use alloc::vec::Vec;

/// Lowest and highest value of each independent joint, as many as there are joints: −∞ and ∞ where there is no limit. A
/// mimic joint's limits are its source joint's, too. Of a ball the value is the angle that it turns from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Where the joints stand in θ and in θ̇.
    pub places: Vec<Place>,
    /// Lowest and highest values, rad or m.
    pub joints: Vec<[f64; 2]>,
    /// Does the joint turn?
    pub turns: Vec<bool>,
}

impl Bounds {
    /// Those of a robot.
    pub fn of(model: &Model) -> Self {
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        let mut joints = vec![free; model.joint_names().len()];
        for (joint, Source { joint: j, ratio, offset }) in model.moving_joints().zip(model.sources()) {
            let (Some(limits), true) = (joint.limits.position, ratio != 0.0) else { continue };
            let [a, b] = limits.map(|x| (x - offset) / ratio);
            let [low, high] = joints[j];
            let both = [low.max(a.min(b)), high.min(a.max(b))];
            // a mimic joint that its source joint's limits never let into its own says nothing
            joints[j] = if both[0] <= both[1] { both } else { joints[j] };
        }
        let turns = model.joints().map(|joint| joint.kind.name() != "prismatic").collect();
        Bounds { places: model.places().to_vec(), joints, turns }
    }

    /// What of joint k is within its bounds: its position, of a ball the angle that it turns from 0.
    ///
    /// # Panics
    /// On a θ of a wrong length, or where there is no joint k.
    pub fn value(&self, theta: &[f64], k: usize) -> f64 {
        self.places[k].bounded_value(theta)
    }
}

impl Place {
    /// What a limit of this joint bounds: its position; of a ball the angle ‖φ‖ that it turns from 0.
    ///
    /// # Panics
    /// On a θ of a wrong length.
    pub fn bounded_value(&self, theta: &[f64]) -> f64 {
        match self.freedom {
            Freedom::Ball => self.rotation_vector(theta).norm(),
            _ => theta[self.q],
        }
    }

    /// The gradient n of [`bounded_value`](Self::bounded_value), whose rate is nᵀθ̇, along the joint's velocities, with
    /// zeros behind it: 1, and φ/‖φ‖ of a ball.
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

    /// Moves the joint to a limit: a ball about its present axis, short of the limit by the rounding of its quaternion,
    /// so that [`bounded_value`](Self::bounded_value) is within.
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
