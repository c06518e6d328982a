//! Signals far beyond the limits of the robot's file: those of one joint in another unit.

use crate::signals::Samples;
use crate::{Finding, Log};
use core::f64::consts::TAU;
use mozzi::Model;

/// Root mean squares above this many limits of effort or velocity, and positions above this many limits and a turn.
const BEYOND: f64 = 3.0;

/// A warning for each kind of signal; `has_forces` is false if currents were logged.
pub fn check(model: &Model, log: &Log, samples: &Samples, has_forces: bool) -> Vec<Finding> {
    let n = model.n();
    if !model.configuration_space().is_flat() || samples.count() == 0 {
        return Vec::new();
    }
    let column = |table: &[f64], j: usize| table.iter().skip(j).step_by(n).copied().collect::<Vec<f64>>();
    let rms = |table: &[f64], j: usize| {
        let x = column(table, j);
        (x.iter().map(|x| x * x).sum::<f64>() / x.len().max(1) as f64).sqrt()
    };
    let (mut forces, mut velocities, mut positions) = (Vec::new(), Vec::new(), Vec::new());
    for (j, name) in model.velocity_names().enumerate() {
        let Some(joint) = model.joints().find(|joint| joint.name == name) else { continue };
        let positive = |limit: Option<f64>| limit.filter(|limit| *limit > 0.0 && limit.is_finite());
        if let Some(limit) = positive(joint.limits.effort).filter(|_| has_forces) {
            let found = rms(&samples.tau, j);
            if found > BEYOND * limit {
                forces.push(format!("{name} {found:.3} (limit {limit})"));
            }
        }
        if let Some(limit) = positive(joint.limits.velocity) {
            let found = rms(&samples.dtheta, j);
            if found > BEYOND * limit {
                velocities.push(format!("{name} {found:.3} (limit {limit})"));
            }
        }
        if let Some([low, high]) = joint.limits.position {
            let limit = low.abs().max(high.abs());
            let found = column(&samples.theta, j).into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            if found > BEYOND * limit + TAU {
                positions.push(format!("{name} up to {found:.3} (limit {limit})"));
            }
        }
    }
    let all = [
        ("forces", "root mean square, ", forces),
        ("velocities", "root mean square, ", velocities),
        ("positions", "", positions),
    ];
    let bad = all.into_iter().filter(|(.., list)| !list.is_empty());
    let warn = |(what, of, list): (&str, &str, Vec<String>)| {
        let text = format!(
            "{}: {what} are far beyond the limits of the robot's file ({of}{}): another unit, or those limits are wrong",
            log.name,
            list.join(", ")
        );
        Finding::warning("limits", text)
    };
    bad.map(warn).collect()
}
