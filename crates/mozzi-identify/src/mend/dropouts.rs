//! Rows in which an encoder reported 0 for a moment.

use super::{at, axes, quantile};
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;

/// A position of exactly 0 that is farther from its neighbours than this many usual steps is a drop-out.
const FAR: f64 = 20.0;

/// A larger share of such rows is a fault.
const MOST: f64 = 0.2;

/// Removes rows in which a position is exactly 0 and far from those before and after.
pub fn remove(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, nq) = (log.rows(), model.nq());
    let mut is_out = zero_rows(log);
    let mut joints: Vec<String> = Vec::new();
    for (q, _, name) in axes(model) {
        let theta = |row: usize| log.theta[row * nq + q];
        let kept: Vec<usize> = (0..N).filter(|&row| theta(row).is_finite() && theta(row) != 0.0).collect();
        if kept.len() == N || kept.len() < N / 2 {
            continue;
        }
        let steps =
            kept.windows(2).filter(|pair| pair[1] == pair[0] + 1).map(|pair| (theta(pair[1]) - theta(pair[0])).abs());
        let usual = quantile(steps.collect(), 0.95);
        for row in (0..N).filter(|&row| theta(row) == 0.0) {
            let after = kept.partition_point(|&other| other < row);
            let neighbours = [after.checked_sub(1).map(|k| kept[k]), kept.get(after).copied()];
            let is_far = neighbours.iter().flatten().all(|&other| theta(other).abs() > FAR * usual);
            if is_far {
                is_out[row] = true;
                if !joints.contains(&name) {
                    joints.push(name.clone());
                }
            }
        }
    }
    let count = is_out.iter().filter(|out| **out).count();
    let Some(first) = is_out.iter().position(|out| *out) else { return };
    let of = if joints.is_empty() { "every joint".to_string() } else { joints.join(", ") };
    let what = format!(
        "{}: in {count} of {N} rows the position of {of} is exactly 0 and far from the rows around it, first at {}: the \
         encoder dropped out",
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
    let has_none: Vec<usize> = (0..N).filter(|&k| row(k).all(|x| *x != 0.0)).collect();
    let is_between = |k: usize| has_none.first().is_some_and(|&a| a < k) && has_none.last().is_some_and(|&b| b > k);
    (0..N).map(|k| is_zero[k] && is_between(k) && has_none.len() > N / 2).collect()
}

impl Log {
    /// Keeps some rows.
    fn keep(&mut self, is_kept: &dyn Fn(usize) -> bool) {
        let N = self.rows();
        let keep = |table: &mut Vec<f64>| {
            let width = table.len() / N.max(1);
            let rows = (0..N).filter(|&row| is_kept(row));
            *table = rows.flat_map(|row| table[row * width..][..width].to_vec()).collect();
        };
        let known = [&mut self.dtheta, &mut self.ddtheta, &mut self.target].into_iter().flatten();
        [&mut self.theta, &mut self.tau].into_iter().chain(known).for_each(keep);
        self.wrenches.iter_mut().for_each(|(_, table)| keep(table));
        keep(&mut self.t);
    }
}
