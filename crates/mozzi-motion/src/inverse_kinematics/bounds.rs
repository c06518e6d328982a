//! Joints within their bounds.

use mozzi::model::Bounds;
use mozzi::random::Random;
use mozzi::{Freedom, SO3, Vec3};
use std::f64::consts::PI;

/// Operations of a search within bounds.
pub(crate) trait Within {
    /// −1 if joint k is at its lower bound, 1 at its upper one, 0 between; a ball's largest angle is its upper bound.
    fn side(&self, theta: &[f64], k: usize) -> f64;

    /// Puts each joint that is beyond a bound onto it.
    fn clamp(&self, theta: &mut [f64]);

    /// Moves the guess in θ to anywhere within the joints' [ranges](Self::range) around it. A floating base and free
    /// joints stay.
    fn randomize(&self, theta: &mut [f64], random: &mut Random);

    /// The bounds of joint k; of an angle, and of a slide without a bound, a turn or two metres of them around a value.
    fn range(&self, k: usize, around: f64) -> [f64; 2];
}

impl Within for Bounds {
    fn side(&self, theta: &[f64], k: usize) -> f64 {
        let ([low, high], place) = (self.joints[k], &self.places[k]);
        match place.freedom {
            Freedom::Free => 0.0,
            Freedom::Ball => f64::from(place.bounded_value(theta) >= high - 1e-12),
            Freedom::One if theta[place.q] <= low => -1.0,
            Freedom::One => f64::from(theta[place.q] >= high),
        }
    }

    fn clamp(&self, theta: &mut [f64]) {
        for k in 0..self.joints.len() {
            self.put_within(theta, k);
        }
    }

    fn randomize(&self, theta: &mut [f64], random: &mut Random) {
        for (k, (place, &[_, high])) in self.places.iter().zip(&self.joints).enumerate() {
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
            let [low, high] = self.range(k, *q);
            *q = 0.5 * (low + high) + 0.5 * (high - low) * random.next();
        }
    }

    fn range(&self, k: usize, around: f64) -> [f64; 2] {
        let ([low, high], turns) = (self.joints[k], self.turns[k]);
        if !turns && (high - low).is_finite() {
            return [low, high];
        }
        let reach = if turns { PI } else { 1.0 };
        let low = low.max(high.min(around + reach) - 2.0 * reach);
        [low, high.min(low + 2.0 * reach)]
    }
}

/// The quaternion of e^{`[turn]`}.
fn turn_to(theta: &mut [f64], turn: Vec3) {
    let (w, v) = SO3::exp(turn).quaternion();
    theta[..4].copy_from_slice(&[w, v.0[0], v.0[1], v.0[2]]);
}
