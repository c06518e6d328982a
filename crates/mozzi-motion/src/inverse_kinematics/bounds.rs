//! How far the joints may go.

use mozzi::Model;
use mozzi::model::description::Source;
use mozzi::random::Random;
use std::f64::consts::PI;

/// Lowest and highest value of each independent joint, as many as there are joints: −∞ and ∞ where there is no limit. A mimic joint's
/// limits are its source joint's, too.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    /// Where the joints begin in θ and in θ̇.
    pub positions: usize,
    pub velocities: usize,
    pub joints: Vec<[f64; 2]>,
    /// Does the joint turn?
    turns: Vec<bool>,
}

impl Bounds {
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
        Bounds { positions: model.base().positions(), velocities: model.base().velocities(), joints, turns }
    }

    /// The joint, if it is one, of velocity j, at its lower (−1) or upper (1) bound: 0 where it is at neither.
    pub fn side(&self, theta: &[f64], j: usize) -> f64 {
        let Some(joint) = j.checked_sub(self.velocities) else { return 0.0 };
        let ([low, high], q) = (self.joints[joint], theta[self.positions + joint]);
        if q <= low {
            -1.0
        } else if q >= high {
            1.0
        } else {
            0.0
        }
    }

    /// Puts each joint that is beyond a bound onto it.
    pub fn clamp(&self, theta: &mut [f64]) {
        for (q, &[low, high]) in theta[self.positions..].iter_mut().zip(&self.joints) {
            *q = q.clamp(low, high);
        }
    }

    /// Anywhere within the bounds; of a joint without, half a turn or a metre around the guess. A floating base stays.
    pub fn random(&self, guess: &[f64], random: &mut Random) -> Vec<f64> {
        let mut theta = guess.to_vec();
        for ((q, &[low, high]), turns) in theta[self.positions..].iter_mut().zip(&self.joints).zip(&self.turns) {
            let reach = if *turns { PI } else { 1.0 };
            let low = if low.is_finite() { low } else { high.min(*q + reach) - 2.0 * reach };
            let high = if high.is_finite() { high } else { low + 2.0 * reach };
            *q = 0.5 * (low + high) + 0.5 * (high - low) * random.next();
        }
        theta
    }
}
