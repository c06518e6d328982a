//! Logs of a robot that does not move.

use crate::mend::spikes;
use crate::{Finding, Log};
use mozzi::{Freedom, Model};

/// Positions that vary by less than this, rad or m, are at rest.
const SMALL: f64 = 1e-3;

/// The squared steps of white noise are twice its variance; those of a motion are far less.
const NOISE: f64 = 0.5;

/// Whether positions are constant but for noise.
pub fn is_at_rest(x: &[f64]) -> bool {
    let N = x.len().max(2) as f64;
    let mean = x.iter().sum::<f64>() / N;
    let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / N;
    let steps = x.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / (N - 1.0);
    range(x) < SMALL || steps > 2.0 * NOISE * variance
}

fn range(x: &[f64]) -> f64 {
    let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    (high - low).max(0.0)
}

/// A fault if no joint moves; only robots whose joints have one axis each and a fixed base are judged.
pub fn check(model: &Model, log: &Log) -> Option<Finding> {
    let (nq, places) = (model.nq(), model.configuration_space().places());
    if places.is_empty() || places.iter().any(|place| place.freedom != Freedom::One) {
        return None;
    }
    let positions =
        |q: usize| -> Vec<f64> { log.theta.iter().skip(q).step_by(nq).copied().filter(|x| x.is_finite()).collect() };
    let all: Vec<Vec<f64>> = places.iter().map(|place| spikes::without(positions(place.q))).collect();
    let most = all.iter().map(|x| range(x)).fold(0.0, f64::max);
    all.iter().all(|x| is_at_rest(x)).then(|| {
        Finding::fault(
            "at_rest",
            format!(
                "{}: the robot does not move: positions vary by at most {most:.1e} rad or m, which is noise; log a \
                 motion of all joints, such as one of `mozzi excite`",
                log.name
            ),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::is_at_rest;

    #[test]
    fn noise_is_rest_and_a_slow_motion_is_not() {
        let noise = mozzi::random::Random(5).vector(500, 0.01);
        assert!(is_at_rest(&noise));
        let motion: Vec<f64> = (0..500).map(|k| 0.05 * (0.02 * f64::from(k)).sin() + 0.2 * noise[k as usize]).collect();
        assert!(!is_at_rest(&motion));
        assert!(is_at_rest(&[0.5; 100]));
    }
}
