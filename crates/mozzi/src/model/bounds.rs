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
        let Place { freedom, q, .. } = self.places[k];
        match freedom {
            Freedom::Ball => SO3::from_quaternion(theta[q], vector(&theta[q + 1..])).log().norm(),
            _ => theta[q],
        }
    }
}

fn vector(list: &[f64]) -> Vec3 {
    Vec3([list[0], list[1], list[2]])
}
