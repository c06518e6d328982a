//! The unit and the resolution of a log's clock.

use super::{axes, quantile};
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;

/// Rows between two positions whose difference is compared with the integral of the velocity.
const WINDOW: usize = 20;

/// A share of rows whose time repeats although their numbers differ.
const REPEATED: f64 = 0.02;

/// Relative error of the rate above which a coarse clock does not determine it.
const UNCERTAIN: f64 = 1e-3;

const UNITS: [(f64, &str); 3] = [(1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")];

/// The unit, then the resolution; fewer rows than 20 tell nothing.
pub fn mend(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    if log.rows() >= 20 {
        unit(model, log, findings);
        resolution(log, findings);
    }
}

/// Converts times in ms, µs or ns to seconds, if the velocities or the sampling rate leave no doubt.
fn unit(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    if log.is_time_certain {
        return;
    }
    let step = quantile(log.t.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect(), 0.5);
    let (found, evidence) = match by_velocity(model, log) {
        Some(ratio) if (0.5..2.0).contains(&ratio) => return,
        Some(ratio) if UNITS.iter().any(|(factor, _)| (0.7..1.4).contains(&(ratio * factor))) => {
            let unit = UNITS.iter().find(|(factor, _)| (0.7..1.4).contains(&(ratio * factor)));
            (unit, format!("the integral of the velocities is {ratio:.0} times the change of the positions"))
        }
        _ if step < 0.5 => return,
        _ => {
            let unit = match step {
                0.5..50.0 => Some(&UNITS[0]),
                200.0..5e4 => Some(&UNITS[1]),
                2e5..5e7 => Some(&UNITS[2]),
                _ => None,
            };
            (unit, format!("its median step is {step:.6}"))
        }
    };
    let Some((factor, unit)) = found else {
        findings.push(Finding::fault(
            "time_unit",
            format!(
                "{}: the unit of time is in doubt: {evidence}; name the column time_s, time_ms, time_us or time_ns",
                log.name
            ),
        ));
        return;
    };
    findings.push(Finding::note(
        "time_unit",
        format!(
            "{}: times are taken as {unit} and converted to s: {evidence}, a rate of {:.1} Hz",
            log.name,
            1.0 / (step * factor)
        ),
    ));
    let log = log.to_mut();
    let start = log.t[0];
    log.t.iter_mut().for_each(|t| *t = (*t - start) * factor);
    log.is_time_certain = true;
}

/// ∫θ̇ dt over Δθ, the median over the joints that agree with it; None without velocities or agreement.
fn by_velocity(model: &Model, log: &Log) -> Option<f64> {
    let dtheta = log.dtheta.as_ref()?;
    let (n, nq) = (model.n(), model.nq());
    let mut ratios = Vec::new();
    for (q, j, _) in axes(model) {
        let (mut along, mut square, mut other) = (0.0, 0.0, 0.0);
        for first in (0..log.rows().saturating_sub(WINDOW)).step_by(WINDOW / 2) {
            let change = log.theta[(first + WINDOW) * nq + q] - log.theta[first * nq + q];
            let integral: f64 = (first..first + WINDOW)
                .map(|row| 0.5 * (dtheta[row * n + j] + dtheta[(row + 1) * n + j]) * (log.t[row + 1] - log.t[row]))
                .sum();
            if change.is_finite() && integral.is_finite() && change.abs() < 3.0 {
                (along, square, other) =
                    (along + change * integral, square + change * change, other + integral * integral);
            }
        }
        if square > 0.0 && along > 0.9 * (square * other).sqrt() {
            ratios.push(along / square);
        }
    }
    let count = ratios.len();
    let median = quantile(ratios.clone(), 0.5);
    let agree = ratios.iter().filter(|ratio| (0.8..1.25).contains(&(**ratio / median))).count();
    (count > 0 && 2 * agree > count).then_some(median)
}

/// A clock whose resolution is coarser than the step: rows at an even rate get even times, others are a fault.
fn resolution(log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let N = log.rows();
    let same_numbers = |row: usize| {
        let width = log.tau.len() / N;
        let of = |table: &[f64], width: usize| table[row * width..][..width] == table[(row - 1) * width..][..width];
        of(&log.tau, width) && of(&log.theta, log.theta.len() / N)
    };
    let repeated: Vec<usize> = (1..N).filter(|&row| log.t[row] == log.t[row - 1] && !same_numbers(row)).collect();
    let Some(&first) = repeated.first().filter(|_| repeated.len() as f64 > REPEATED * N as f64) else { return };
    if (1..N).any(|row| log.t[row] < log.t[row - 1]) {
        return; // no increasing times, which `check` says
    }
    let steps: Vec<f64> = (1..N).map(|row| log.t[row] - log.t[row - 1]).filter(|step| *step > 0.0).collect();
    let coarse = quantile(steps.clone(), 0.02);
    let distinct = steps.len() as f64 + 1.0;
    // least squares of t = a + b k
    let (mean, half) = (log.t.iter().sum::<f64>() / N as f64, 0.5 * (N as f64 - 1.0));
    let square: f64 = (0..N).map(|k| (k as f64 - half).powi(2)).sum();
    let rate = log.t.iter().enumerate().map(|(k, t)| (k as f64 - half) * (t - mean)).sum::<f64>() / square;
    let even = |k: usize| mean + (k as f64 - half) * rate;
    let most = log.t.iter().enumerate().map(|(k, t)| (t - even(k)).abs()).fold(0.0, f64::max);
    let duration = log.t[N - 1] - log.t[0];
    let is_known = duration > 0.0 && coarse / (duration * distinct.sqrt()) < UNCERTAIN && most <= coarse;
    let what = format!(
        "{}: {} of {N} rows have the time of the row before, first at {}: the clock's resolution is {coarse:.3e} s, as \
         of times that are printed with six digits (%g)",
        log.name,
        repeated.len(),
        super::at(log, first)
    );
    if !is_known {
        let remedy = "log more digits, such as %.9f, or seconds since the start";
        findings.push(Finding::fault("clock_resolution", format!("{what}; {remedy}")));
        return;
    }
    let finding =
        format!("{what}; the rows lie within {most:.2e} s of an even rate of {:.3} Hz, which is used", 1.0 / rate);
    findings.push(Finding::note("clock_resolution", finding));
    log.to_mut().t = (0..N).map(|k| k as f64 * rate).collect();
}
