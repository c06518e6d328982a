//! Forces far outside of what a joint ever has: errors of a transmission.

use super::{at, axes, quantile};
use crate::cores::each;
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;

/// A spike is above this many times what 99 % of the joint's forces have,
const ABOVE_USUAL: f64 = 20.0;

/// or above this many times the effort limit, if the other forces are near it or below.
const ABOVE_LIMIT: f64 = 10.0;

/// A larger share of such rows is no row of spikes.
const MOST: f64 = 0.01;

/// Removes rows with a force that cannot be.
pub fn remove(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, n) = (log.rows(), model.n());
    let limits: Vec<_> = model.joints().map(|joint| (joint.name.clone(), joint.limits.effort)).collect();
    let mut is_out = vec![false; N];
    let axes = axes(model);
    let found = each(axes.len(), log.tau.len(), |k| {
        let (_, j, name) = &axes[k];
        let force = |row: usize| log.tau[row * n + j].abs();
        let usual = quantile((0..N).map(force).collect(), 0.99);
        let limit = limits.iter().find(|(joint, _)| joint == name).and_then(|(_, effort)| *effort);
        let bound = match limit.filter(|limit| *limit > 0.0 && usual <= 2.0 * limit) {
            Some(limit) => (ABOVE_USUAL * usual).min(ABOVE_LIMIT * limit).max(limit),
            None => ABOVE_USUAL * usual,
        };
        (usual, bound, (0..N).filter(|&row| force(row) > bound).collect::<Vec<usize>>())
    });
    for ((usual, bound, spikes), (_, j, name)) in found.into_iter().zip(&axes) {
        let Some(&first) = spikes.first().filter(|_| usual > 0.0 && spikes.len() as f64 <= MOST * N as f64) else {
            continue;
        };
        findings.push(Finding::warning(
            "spike",
            format!(
                "{}: the force of {name} is above {bound:.3e} in {} of {N} rows, first {:.3e} at {}, and below \
                 {usual:.3e} in 99 % of them: an error of the sensor or its transmission; these rows are left out",
                log.name,
                spikes.len(),
                log.tau[first * n + j],
                at(log, first)
            ),
        ));
        spikes.iter().for_each(|&row| is_out[row] = true);
    }
    if is_out.contains(&true) {
        log.to_mut().keep(&|row| !is_out[row]);
    }
}
