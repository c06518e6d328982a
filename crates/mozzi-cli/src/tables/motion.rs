//! A table of a motion over time, for `simulate --follow`, `plot` and `view`: read and mended as `identify` reads logs.

use super::How;
use super::degrees;
use super::join::join;
use super::samples::Samples;
use crate::failure::{self, Failure, Result};
use crate::recogniser::Request;
use mozzi::Model;
use mozzi_identify::{Level, Log, order};

/// Cells may lack numbers, and the last row may be cut off.
pub const HOW: How = How { request: Request::NONE, may_miss: true };

/// Fewer rows do not tell the unit of time without velocities.
const ROWS: usize = 100;

/// If no joint is faster than this in the unit of the times, rad or m, the unit is shorter than a second.
const SLOW: f64 = 0.01;

/// Leaves out rows without numbers and repeated ones, converts times to seconds, unwraps positions, and counts times
/// from the first row if that is farther from 0 than the motion is long.
pub fn mended(mut samples: Samples, model: &Model) -> Result<Samples> {
    degrees::question(&samples, model);
    if samples.t.is_none() || samples.count == 0 {
        return Ok(samples);
    }
    join(&mut samples, model, "")?;
    leave_out(&mut samples)?;
    clock(&mut samples, model)?;
    let file = samples.file.clone();
    let Some(t) = &mut samples.t else { return Ok(samples) };
    let (first, last) = (t[0], t[t.len() - 1]);
    if last > first && first.abs() > last - first {
        t.iter_mut().for_each(|t| *t -= first);
        samples.start += first;
    }
    if samples.start != 0.0 {
        failure::note(&format!("{file}: times are counted from the first row, t = {} s", samples.start));
    }
    Ok(samples)
}

/// Leaves out rows in which a number is missing, and those that repeat the row before with its time.
fn leave_out(samples: &mut Samples) -> Result<()> {
    let N = samples.count;
    let tables: Vec<&Vec<f64>> = samples.t.iter().chain(samples.tables.values()).collect();
    let of = |table: &'_ [f64], row: usize| -> std::ops::Range<usize> {
        let width = table.len() / N;
        row * width..(row + 1) * width
    };
    let is_whole = |row: usize| tables.iter().all(|table| table[of(table, row)].iter().all(|x| x.is_finite()));
    let whole: Vec<usize> = (0..N).filter(|&row| is_whole(row)).collect();
    let missing = N - whole.len();
    if let Some(first) = (0..N).find(|&row| !is_whole(row)) {
        let (file, place) = (&samples.file, samples.place(first));
        let what = format!("{file}: {missing} of {N} rows lack numbers or hold NaN, first {place}");
        if missing as f64 > Log::MOST_MISSING * N as f64 {
            let most = 100.0 * Log::MOST_MISSING;
            return Err(Failure::wrong(format!("{what}, expected at most {most} %; delete these rows")));
        }
        failure::note(&format!("{what}; they are left out"));
    }
    let mut rows: Vec<usize> = Vec::with_capacity(whole.len());
    for row in whole {
        let is_same = |before: usize| tables.iter().all(|table| table[of(table, row)] == table[of(table, before)]);
        if rows.last().is_none_or(|&before| !is_same(before)) {
            rows.push(row);
        }
    }
    let repeated = N - missing - rows.len();
    if repeated > 0 {
        failure::note(&format!("{}: {repeated} of {N} rows repeat the row before and are left out", samples.file));
    }
    if rows.len() < N {
        samples.keep(&rows);
    }
    Ok(())
}

/// Converts times in ms, µs or ns, and times of too few digits, and unwraps positions, by the rules of `identify`.
fn clock(samples: &mut Samples, model: &Model) -> Result<()> {
    let mut log = Log { name: samples.file.clone(), t: samples.t.take().unwrap_or_default(), ..Log::default() };
    log.theta = samples.tables.remove("theta").unwrap_or_default();
    log.dtheta = samples.tables.remove("dtheta");
    log.is_time_certain = samples.is_time_certain || !may_be_shorter(&log, model);
    let found = if log.theta.is_empty() { None } else { log.with_clock_and_turns(model) };
    if let Some((mended, findings)) = found {
        for finding in findings {
            match finding.level {
                Level::Fault if finding.code == "time_unit" => {} // rows may be a minute apart
                Level::Fault => return Err(Failure::wrong(finding.text)),
                _ => failure::write(&format!("{finding}\n")),
            }
        }
        log = mended;
    }
    samples.t = Some(log.t);
    samples.tables.extend((!log.theta.is_empty()).then_some(("theta".to_string(), log.theta)));
    samples.tables.extend(log.dtheta.map(|table| ("dtheta".to_string(), table)));
    // an impact may have two rows at one time
    in_order(samples, |t, before| t < before)
}

/// Whether the times may be in a unit shorter than a second: if velocities can decide, or no joint would move.
fn may_be_shorter(log: &Log, model: &Model) -> bool {
    if log.dtheta.as_ref().is_some_and(|table| table.iter().any(|x| *x != 0.0)) {
        return true;
    }
    let nq = model.nq().max(1);
    let speed = (nq..log.theta.len()).map(|k| {
        let step = log.t[k / nq] - log.t[k / nq - 1];
        if step > 0.0 { (log.theta[k] - log.theta[k - nq]).abs() / step } else { 0.0 }
    });
    let fastest = speed.fold(0.0, f64::max);
    log.t.len() >= ROWS && fastest > 0.0 && fastest < SLOW
}

/// Checks that the times of a table increase.
pub fn check(samples: &Samples) -> Result<()> {
    in_order(samples, |t, before| t <= before)
}

fn in_order(samples: &Samples, is_wrong: fn(f64, f64) -> bool) -> Result<()> {
    let times = samples.times()?;
    match (1..times.len()).find(|&row| is_wrong(times[row], times[row - 1])) {
        None => Ok(()),
        Some(row) => {
            let (place, t, before) = (samples.place(row), times[row], times[row - 1]);
            let why = order::explain(times, row);
            Err(Failure::wrong(format!("{place}: t is {t} after {before}, expected increasing times: {why}")))
        }
    }
}
