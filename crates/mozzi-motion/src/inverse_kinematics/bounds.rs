//! How far the joints may go.

use mozzi::model::description::Source;
use mozzi::random::Random;
use mozzi::{Freedom, Model, Place, SE3, SO3, Vec3};
use std::f64::consts::PI;

/// Lowest and highest value of each independent joint, as many as there are joints: −∞ and ∞ where there is no limit. A mimic joint's
/// limits are its source joint's, too. Of a ball the value is the angle that it turns from 0.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    /// Where the joints stand in θ and in θ̇.
    pub places: Vec<Place>,
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
        Bounds { places: model.places().to_vec(), joints, turns }
    }

    /// What of joint k is within its bounds: its position, of a ball the angle that it turns from 0.
    pub fn value(&self, theta: &[f64], k: usize) -> f64 {
        let Place { freedom, q, .. } = self.places[k];
        match freedom {
            Freedom::Ball => SO3::from_quaternion(theta[q], vector(&theta[q + 1..])).log().norm(),
            _ => theta[q],
        }
    }

    /// The joint, if it is one of one axis, of velocity j, at its lower (−1) or upper (1) bound: 0 where it is at neither.
    pub fn side(&self, theta: &[f64], j: usize) -> f64 {
        let is_it = |place: &Place| place.freedom == Freedom::One && place.j == j;
        let Some(joint) = self.places.iter().position(is_it) else { return 0.0 };
        let ([low, high], q) = (self.joints[joint], self.value(theta, joint));
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
        for (k, (&Place { freedom, q, .. }, &[low, high])) in self.places.iter().zip(&self.joints).enumerate() {
            match freedom {
                Freedom::One => theta[q] = theta[q].clamp(low, high),
                Freedom::Ball if self.value(theta, k) > high => {
                    let turn = SO3::from_quaternion(theta[q], vector(&theta[q + 1..])).log();
                    turn_to(&mut theta[q..], turn * (high / turn.norm()));
                }
                _ => {}
            }
        }
    }

    /// Anywhere within the bounds; of a joint without, half a turn or a metre around the guess. A floating base and free joints stay.
    pub fn random(&self, guess: &[f64], random: &mut Random) -> Vec<f64> {
        let mut theta = guess.to_vec();
        for ((place, &[low, high]), turns) in self.places.iter().zip(&self.joints).zip(&self.turns) {
            let q = match place.freedom {
                Freedom::One => &mut theta[place.q],
                Freedom::Ball => {
                    let turn = Vec3(random.array()) * PI;
                    let most = high.min(PI);
                    turn_to(&mut theta[place.q..], turn * (most / turn.norm().max(most)));
                    continue;
                }
                Freedom::Free => continue,
            };
            let reach = if *turns { PI } else { 1.0 };
            let low = if low.is_finite() { low } else { high.min(*q + reach) - 2.0 * reach };
            let high = if high.is_finite() { high } else { low + 2.0 * reach };
            *q = 0.5 * (low + high) + 0.5 * (high - low) * random.next();
        }
        theta
    }
}

fn vector(list: &[f64]) -> Vec3 {
    Vec3([list[0], list[1], list[2]])
}

/// The quaternion of e^{`[turn]`}.
fn turn_to(theta: &mut [f64], turn: Vec3) {
    theta[..4].copy_from_slice(&SE3 { R: SO3::exp(turn), p: Vec3([0.0; 3]) }.to_pose()[..4]);
}
