//! Numbers far outside of what a joint ever has: errors of a transmission.

use super::{at, axes, quantile};
use crate::cores::each;
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;

/// A spike is above this many times what 99 % of the joint's numbers have,
const ABOVE_USUAL: f64 = 20.0;

/// or, of a force, above this many times the effort limit, if the other forces are near it or below.
const ABOVE_LIMIT: f64 = 10.0;

/// A larger share of such rows is no row of spikes,
const MOST: f64 = 0.01;

/// nor are more consecutive rows of a position or a velocity: the joint moved.
const TOGETHER: usize = 3;

/// Spikes of one signal.
struct Spikes {
    /// 99 % of the numbers are below.
    usual: f64,
    bound: f64,
    rows: Vec<usize>,
}

impl Spikes {
    /// Whether there are spikes, in so few of `count` rows that they are errors.
    fn are_few(&self, count: usize) -> bool {
        self.usual > 0.0 && !self.rows.is_empty() && self.rows.len() as f64 <= MOST * count as f64
    }
}

/// Removes rows with a force, a velocity or a position that cannot be.
pub fn remove(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, n, nq) = (log.rows(), model.n(), model.nq());
    let limits: Vec<_> = model.joints().map(|joint| (joint.name.clone(), joint.limits.effort)).collect();
    let mut is_out = vec![false; N];
    let axes = axes(model);
    let tables = [("force", Some(&log.tau)), ("velocity", log.dtheta.as_ref()), ("position", Some(&log.theta))];
    for (what, table) in tables.into_iter().filter_map(|(what, table)| Some((what, table?))) {
        let found = each(axes.len(), table.len(), |k| {
            let (q, j, name) = &axes[k];
            let (width, at) = if what == "position" { (nq, *q) } else { (n, *j) };
            let x: Vec<f64> = (0..N).map(|row| table[row * width + at]).collect();
            let limit = limits.iter().find(|(joint, _)| joint == name).and_then(|(_, effort)| *effort);
            of_signal(&x, what == "position", limit.filter(|_| what == "force"))
        });
        let mut joints = Vec::new();
        for (spikes, (q, j, name)) in found.into_iter().zip(&axes) {
            if !spikes.are_few(N) || what != "force" && !are_apart(&spikes.rows) {
                continue;
            }
            let Spikes { usual, bound, rows } = spikes;
            let first = rows[0];
            let value = if what == "position" { table[first * nq + q] } else { table[first * n + j] };
            joints.push(format!(
                "{name} in {} of {N} rows, first {value:.3e} at {}, where 99 % are below {usual:.3e} and spikes above \
                 {bound:.3e}",
                rows.len(),
                at(log, first)
            ));
            rows.iter().for_each(|&row| is_out[row] = true);
        }
        if let Some((first, more)) = joints.split_first() {
            let of = if what == "position" { ", from the median" } else { "" };
            let others = if more.is_empty() { String::new() } else { format!(", and {} other joints", more.len()) };
            let text = format!(
                "{}: the {what} jumps far away for a moment: {first}{of}{others}: an error of the sensor or its \
                 transmission; these rows are left out",
                log.name
            );
            findings.push(Finding::warning("spike", text));
        }
    }
    if is_out.contains(&true) {
        log.to_mut().keep(&|row| !is_out[row]);
    }
}

fn of_signal(x: &[f64], is_centered: bool, limit: Option<f64>) -> Spikes {
    let middle = if is_centered { quantile(x.to_vec(), 0.5) } else { 0.0 };
    let size = |row: usize| (x[row] - middle).abs();
    let usual = quantile((0..x.len()).map(size).collect(), 0.99);
    let bound = match limit.filter(|limit| *limit > 0.0 && usual <= 2.0 * limit) {
        Some(limit) => (ABOVE_USUAL * usual).min(ABOVE_LIMIT * limit).max(limit),
        None => ABOVE_USUAL * usual,
    };
    let rows: Vec<usize> = (0..x.len()).filter(|&row| size(row) > bound).collect();
    Spikes { usual, bound, rows }
}

/// Whether few of the rows follow each other.
fn are_apart(rows: &[usize]) -> bool {
    rows.windows(TOGETHER + 1).all(|run| run[TOGETHER] - run[0] > TOGETHER)
}

/// The numbers without spikes.
pub fn without(x: Vec<f64>) -> Vec<f64> {
    let spikes = of_signal(&x, true, None);
    if !spikes.are_few(x.len()) || !are_apart(&spikes.rows) {
        return x;
    }
    (0..x.len()).filter(|row| spikes.rows.binary_search(row).is_err()).map(|row| x[row]).collect()
}
