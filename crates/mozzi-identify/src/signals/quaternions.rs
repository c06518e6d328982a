//! Quaternions of floating bases, balls and free joints before and after the filter.

use mozzi::{Freedom, Model};

/// Makes quaternions continuous in time: q and −q are the same orientation.
pub fn continuous(model: &Model, theta: &mut [Vec<f64>]) {
    for place in model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One) {
        let q = place.q;
        for k in 1..theta[q].len() {
            let dot: f64 = (q..q + 4).map(|i| theta[i][k] * theta[i][k - 1]).sum();
            if dot < 0.0 {
                (q..q + 4).for_each(|i| theta[i][k] = -theta[i][k]);
            }
        }
    }
}

/// Gives filtered quaternions the length 1 again.
pub fn normalize(model: &Model, theta: &mut [Vec<f64>]) {
    for place in model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One) {
        let q = place.q;
        for k in 0..theta[q].len() {
            let length = (q..q + 4).map(|i| theta[i][k].powi(2)).sum::<f64>().sqrt();
            (q..q + 4).for_each(|i| theta[i][k] /= length);
        }
    }
}
