//! Quaternions of floating bases, balls and free joints before and after the filter, and their velocities.

use mozzi::{Freedom, Model};

/// Fills in the velocities of floating bases, balls and free joints, by central differences of positions, whose
/// quaternions are [continuous] and [normalized](normalize).
pub fn differentiate(model: &Model, theta: &[Vec<f64>], step: f64, dtheta: &mut [Vec<f64>]) {
    let space = model.configuration_space();
    let places = || space.places().iter().filter(|place| place.freedom != Freedom::One);
    if places().next().is_none() {
        return;
    }
    let at = |k: usize| -> Vec<f64> { theta.iter().map(|x| x[k]).collect() };
    let (mut difference, N) = (vec![0.0; model.n()], theta[0].len());
    for k in 0..N {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(N - 1));
        space.difference(&at(before), &at(after), &mut difference);
        for j in places().flat_map(|place| place.velocities()) {
            dtheta[j][k] = difference[j] / ((after - before).max(1) as f64 * step);
        }
    }
}

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
