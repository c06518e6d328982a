//! Rounding errors of results, which pages show as 0.

use mozzi::quantities::Query;
use mozzi::{Environment, Model};

/// Relative size of the changes of inputs from which the unit of error is extrapolated.
const STEP: f64 = 1e-6;
/// An entry up to so many units is noise.
const NOISE: f64 = 16.0;

/// The outputs with their noise as 0. The unit of error of an entry is its change when each input changes by ε of its
/// size, or of 1 if that is larger: as for docs/accuracy.md, but for the robot's constants.
pub fn cleaned(
    query: Query,
    model: &Model,
    inputs: &[Vec<f64>],
    environment: &Environment,
    outputs: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut cleaned = outputs.to_vec();
    let is_small = |x: f64| x != 0.0 && x.abs() < 1e-9;
    if !outputs.iter().flatten().any(|&x| is_small(x)) {
        return cleaned;
    }
    let mut units: Vec<Vec<f64>> = outputs.iter().map(|output| vec![0.0; output.len()]).collect();
    for k in 0..inputs.len() {
        for i in 0..inputs[k].len() {
            let mut changed = inputs.to_vec();
            changed[k][i] += STEP * inputs[k][i].abs().max(1.0);
            let slices: Vec<&[f64]> = changed.iter().map(Vec::as_slice).collect();
            let Ok(found) = model.compute(query, &slices, environment) else { continue };
            for ((unit, x), y) in units.iter_mut().flatten().zip(found.iter().flatten()).zip(outputs.iter().flatten()) {
                *unit += (x - y).abs() * f64::EPSILON / STEP;
            }
        }
    }
    for (x, unit) in cleaned.iter_mut().flatten().zip(units.iter().flatten()) {
        if is_small(*x) && x.abs() <= NOISE * unit {
            *x = 0.0;
        }
    }
    cleaned
}

#[cfg(test)]
mod tests {
    use super::cleaned;
    use mozzi::quantities::{GravityForces, KineticEnergy, Query};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn noise_is_zero_and_small_results_stay() {
        let model = mozzi_urdf::open("double_pendulum").expect("embedded").build().expect("sound");
        let environment = model.environment();
        let at = |query: Query, inputs: &[Vec<f64>]| {
            let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
            let found = model.compute(query, &slices, &environment).expect("sound");
            (found[0].clone(), cleaned(query, &model, inputs, &environment, &found)[0].clone())
        };
        // both links vertical, by an angle that is π/2 but for rounding
        for turned in [2.0 * FRAC_PI_2, 4.0 * FRAC_PI_2] {
            let (raw, clean) = at(GravityForces.into(), &[vec![turned, 0.0]]);
            assert!(raw.iter().all(|x| x.abs() < 1e-14) && clean == [0.0, 0.0], "{raw:?} {clean:?}");
        }
        let (raw, clean) = at(KineticEnergy.into(), &[vec![0.3, 0.2], vec![1e-6, 0.0]]);
        assert!(raw[0] > 0.0 && raw == clean, "{raw:?}");
    }
}
