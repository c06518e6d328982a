//! Joints within their bounds.

use mozzi::model::Bounds;
use mozzi::random::Random;
use mozzi::{Freedom, Place, SE3, SO3, Vec3};
use std::f64::consts::PI;

/// What a search under bounds needs.
pub(crate) trait Within {
    /// The joint, if it is one of one axis, of velocity j, at its lower (−1) or upper (1) bound: 0 where it is at
    /// neither.
    fn side(&self, theta: &[f64], j: usize) -> f64;

    /// Puts each joint that is beyond a bound onto it.
    fn clamp(&self, theta: &mut [f64]);

    /// Anywhere within the bounds; of a joint without, half a turn or a metre around the guess. A floating base and
    /// free joints stay.
    fn random(&self, guess: &[f64], random: &mut Random) -> Vec<f64>;
}

impl Within for Bounds {
    fn side(&self, theta: &[f64], j: usize) -> f64 {
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

    fn clamp(&self, theta: &mut [f64]) {
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

    fn random(&self, guess: &[f64], random: &mut Random) -> Vec<f64> {
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
