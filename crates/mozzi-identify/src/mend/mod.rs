//! Mends what a log's driver got wrong in a way that leaves no doubt: the unit and the resolution of its clock,
//! sensors that drop out or stay constant, spikes, positions that wrap. What is in doubt is a fault.

mod clock;
mod dropouts;
pub(crate) mod spikes;
mod stuck;
mod wrap;

use crate::{Error, Finding, Log};
use mozzi::model::description::JointKind;
use mozzi::{Freedom, Model};
use std::borrow::Cow;

/// The log as it can be filtered, and what was changed.
///
/// # Errors
/// [`Error::WrongLength`].
pub fn mend<'l>(model: &Model, log: &'l Log) -> Result<(Cow<'l, Log>, Vec<Finding>), Error> {
    log.check_lengths(model)?;
    let mut log = Cow::Borrowed(log);
    let mut findings = Vec::new();
    if log.rows() < 20 {
        return Ok((log, findings)); // too short, which `check` says
    }
    clock::mend(model, &mut log, &mut findings);
    dropouts::remove(model, &mut log, &mut findings);
    spikes::remove(model, &mut log, &mut findings);
    wrap::unwrap(model, &mut log, &mut findings);
    stuck::check(model, &mut log, &mut findings);
    Ok((log, findings))
}

/// The joints of one axis: their place in θ and in θ̇, and their name.
fn axes(model: &Model) -> Vec<(usize, usize, String)> {
    let names: Vec<&str> = model.velocity_names().collect();
    let one = model.places().iter().filter(|place| place.freedom == Freedom::One).cloned();
    one.map(|place| (place.q, place.j, names[place.j].to_string())).collect()
}

/// Whether a joint turns without moving along its axis.
pub(crate) fn is_revolute(model: &Model, name: &str) -> bool {
    let joint = model.joints().find(|joint| joint.name == name);
    joint.is_some_and(|joint| matches!(&joint.kind, JointKind::Screw(a) if !a.is_prismatic() && a.pitch() == 0.0))
}

/// The value below which this share of the numbers lies; 0 without numbers.
fn quantile(mut numbers: Vec<f64>, share: f64) -> f64 {
    numbers.retain(|x| x.is_finite());
    let at = (numbers.len().saturating_sub(1) as f64 * share) as usize;
    if numbers.is_empty() { 0.0 } else { *numbers.select_nth_unstable_by(at, f64::total_cmp).1 }
}

/// The time of a row, or its number if it has none.
fn at(log: &Log, row: usize) -> String {
    format!("t = {:.4} s, row {row} (counted from 0)", log.t[row])
}

impl Log {
    /// Times in seconds, if those of the log are in another unit or have too few digits, positions that do not wrap,
    /// and what was found about both. Forces may be missing.
    pub fn with_clock_and_turns(&self, model: &Model) -> Option<(Log, Vec<Finding>)> {
        let (mut log, mut findings) = (Cow::Borrowed(self), Vec::new());
        clock::mend(model, &mut log, &mut findings);
        let mut of_turns = Vec::new();
        wrap::unwrap(model, &mut log, &mut of_turns);
        findings.extend(of_turns.into_iter().filter(|finding| finding.code == "wrapped"));
        (!findings.is_empty()).then(|| (log.into_owned(), findings))
    }

    /// Keeps some rows.
    fn keep(&mut self, is_kept: &dyn Fn(usize) -> bool) {
        let N = self.rows();
        let keep = |table: &mut Vec<f64>| {
            let width = table.len() / N.max(1);
            let rows = (0..N).filter(|&row| is_kept(row));
            *table = rows.flat_map(|row| &table[row * width..][..width]).copied().collect();
        };
        let known = [&mut self.dtheta, &mut self.ddtheta, &mut self.target].into_iter().flatten();
        [&mut self.theta, &mut self.tau].into_iter().chain(known).for_each(keep);
        self.wrenches.iter_mut().for_each(|(_, table)| keep(table));
        keep(&mut self.t);
    }
}
