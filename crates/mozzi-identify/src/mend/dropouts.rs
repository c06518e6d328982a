//! Rows in which a sensor reported 0 for a moment.

use super::{at, axes, quantile};
use crate::cores::each;
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;

/// A number of exactly 0 that is farther from its neighbours than this many usual steps is a drop-out: of a position,
/// and of a velocity or a force, whose steps are larger.
const FAR: (f64, f64) = (20.0, 5.0);

/// A larger share of such rows is a fault.
const MOST: f64 = 0.2;

/// Removes rows in which a position, velocity or force is exactly 0 and far from those before and after.
pub fn remove(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, n, nq) = (log.rows(), model.n(), model.nq());
    let mut is_out = zero_rows(log);
    let mut signals: Vec<String> = Vec::new();
    let tables: [(_, Option<&[f64]>); 3] =
        [("position", Some(&log.theta)), ("velocity", log.dtheta.as_deref()), ("force", Some(&log.tau))];
    let known = tables.iter().filter_map(|(what, table)| table.map(|table| (*what, table)));
    for (what, table) in known {
        let mut joints: Vec<String> = Vec::new();
        let axes = axes(model);
        let found = each(axes.len(), table.len(), |of| {
            let (q, j, _) = axes[of];
            let (width, k, far) = if what == "position" { (nq, q, FAR.0) } else { (n, j, FAR.1) };
            far_zeros(&(0..N).map(|row| table[row * width + k]).collect::<Vec<_>>(), far)
        });
        for (rows, (.., name)) in found.into_iter().zip(&axes) {
            if !rows.is_empty() {
                joints.push(name.clone());
            }
            rows.into_iter().for_each(|row| is_out[row] = true);
        }
        if !joints.is_empty() {
            let of = if joints.len() == axes.len() { "every joint".into() } else { joints.join(", ") };
            signals.push(format!("the {what} of {of}"));
        }
    }
    let count = is_out.iter().filter(|out| **out).count();
    let Some(first) = is_out.iter().position(|out| *out) else { return };
    let of = if signals.is_empty() { "every column".to_string() } else { signals.join(" and ") };
    let what = format!(
        "{}: in {count} of {N} rows {of} is exactly 0 and far from the rows around it, first at {}: the sensor dropped \
         out",
        log.name,
        at(log, first)
    );
    if count as f64 > MOST * N as f64 {
        findings.push(Finding::fault("drop_out", format!("{what}; remove these rows")));
        return;
    }
    findings.push(Finding::warning("drop_out", format!("{what}; these rows are left out")));
    log.to_mut().keep(&|row| !is_out[row]);
}

/// Rows in which a signal that is rarely 0 is exactly 0 and farther from its neighbours than some usual steps.
fn far_zeros(x: &[f64], far: f64) -> Vec<usize> {
    if !x.contains(&0.0) {
        return Vec::new();
    }
    let N = x.len();
    let kept: Vec<usize> = (0..N).filter(|&row| x[row].is_finite() && x[row] != 0.0).collect();
    if kept.len() < N / 2 {
        return Vec::new();
    }
    let steps = kept.windows(2).filter(|pair| pair[1] == pair[0] + 1).map(|pair| (x[pair[1]] - x[pair[0]]).abs());
    let usual = quantile(steps.collect(), 0.95);
    let is_far = |row: &usize| {
        let after = kept.partition_point(|other| other < row);
        let neighbours = [after.checked_sub(1).map(|k| kept[k]), kept.get(after).copied()];
        neighbours.iter().flatten().all(|&other| x[other].abs() > far * usual)
    };
    (0..N).filter(|&row| x[row] == 0.0).filter(is_far).collect()
}

/// Rows with nothing but zeros between rows that have none.
fn zero_rows(log: &Log) -> Vec<bool> {
    let N = log.rows();
    let tables: Vec<&[f64]> =
        [log.theta.as_slice(), log.tau.as_slice()].into_iter().chain(log.dtheta.as_deref()).collect();
    let row = |row: usize| {
        tables.iter().flat_map(move |table| {
            let width = table.len() / N.max(1);
            &table[row * width..][..width]
        })
    };
    let is_zero: Vec<bool> = (0..N).map(|k| row(k).all(|x| *x == 0.0)).collect();
    if !is_zero.contains(&true) {
        return is_zero;
    }
    let has_none: Vec<usize> = (0..N).filter(|&k| row(k).all(|x| *x != 0.0)).collect();
    let is_between = |k: usize| has_none.first().is_some_and(|&a| a < k) && has_none.last().is_some_and(|&b| b > k);
    (0..N).map(|k| is_zero[k] && is_between(k) && has_none.len() > N / 2).collect()
}
