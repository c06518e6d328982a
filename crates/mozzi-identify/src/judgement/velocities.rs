//! Compares logged velocities with differentiated positions: signs, units, mixed-up joints, velocities of another
//! motion, and delays of filters that ran forwards only.

use super::base_velocity;
use super::rest::is_at_rest;
use crate::cores::each;
use crate::log::Rows;
use crate::signals::butterworth::LowPass;
use crate::signals::{continuous, derivative, differentiate, normalize, resampled};
use crate::{Finding, Log};
use mozzi::model::Place;
use mozzi::{Freedom, Model};

/// A velocity belongs to its position above this correlation.
const ALIKE: f64 = 0.9;

/// Relative difference, after the filter, above which the velocity is of another motion; a warning at a third of it.
const APART: f64 = 0.1;

/// A velocity that comes earlier by more than this, s, is no measured one.
const EARLY: f64 = 4e-3;

/// Joints slower than this share of the fastest one are not compared.
const SLOW: f64 = 0.02;

/// Positions with their derivatives, logged velocities and forces, all through the fit's low-pass filter.
struct Signals {
    /// None of robots whose joints have one axis each.
    theta: Vec<Vec<f64>>,
    /// Derivatives of positions.
    slopes: Vec<Vec<f64>>,
    logged: Vec<Vec<f64>>,
    forces: Vec<Vec<f64>>,
    step: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The correlation of two signals about their means.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len().max(1) as f64;
    let means = (mean(a), mean(b));
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (a - means.0, b - means.1);
        (aa, bb, ab) = (aa + a * a, bb + b * b, ab + a * b);
    }
    let size = f64::sqrt(aa * bb);
    if size > 0.0 { ab / size } else { 0.0 }
}

impl Signals {
    fn new(
        model: &Model,
        log: &Log,
        rows: &Rows,
        dtheta: &[f64],
        low_pass: Option<&LowPass>,
        trim: usize,
    ) -> Option<Self> {
        let (n, nq) = (model.n(), model.nq());
        let run = rows.runs.iter().max_by_key(|run| run.len()).filter(|run| run.len() > 2 * trim + 20)?;
        let t: Vec<f64> = run.iter().map(|&row| log.t[row]).collect();
        let even = |table: &[f64], width: usize, k: usize| -> Vec<f64> {
            resampled(&t, &run.iter().map(|&row| table[row * width + k]).collect::<Vec<_>>(), rows.step)
        };
        let filtered = |mut x: Vec<f64>| {
            if let Some(low_pass) = low_pass {
                low_pass.filter(&mut x);
            }
            x
        };
        let ends = trim.max(3);
        let inner = |x: Vec<f64>| x.get(ends..x.len().saturating_sub(ends)).unwrap_or_default().to_vec();
        let all = |table: &[f64]| each(n, n * run.len(), |j| inner(filtered(even(table, n, j))));
        let (theta, slopes) = match model.configuration_space().is_flat() {
            true => (Vec::new(), each(n, n * run.len(), |j| derivative(&filtered(even(&log.theta, n, j)), rows.step))),
            false => {
                let mut theta = each(nq, nq * run.len(), |k| even(&log.theta, nq, k));
                continuous(model, &mut theta);
                theta.iter_mut().for_each(|x| *x = filtered(core::mem::take(x)));
                normalize(model, &mut theta);
                let mut slopes = vec![vec![0.0; theta.first().map_or(0, Vec::len)]; n];
                for place in model.configuration_space().places().iter().filter(|place| place.freedom == Freedom::One) {
                    slopes[place.j] = derivative(&theta[place.q], rows.step);
                }
                differentiate(model, &theta, rows.step, &mut slopes);
                (theta, slopes)
            }
        };
        Some(Signals {
            theta: theta.into_iter().map(inner).collect(),
            slopes: slopes.into_iter().map(inner).collect(),
            logged: all(dtheta),
            forces: all(&log.tau),
            step: rows.step,
        })
    }

    /// δ of θ̇(t − δ) ≈ θ′ − δ θ″, by least squares: along, square.
    fn lag(&self, j: usize) -> (f64, f64) {
        let second = derivative(&self.slopes[j], self.step);
        let rest: Vec<f64> = self.logged[j].iter().zip(&self.slopes[j]).map(|(a, b)| a - b).collect();
        (-dot(&rest, &second), dot(&second, &second))
    }
}

/// The positions of a joint in the rows that are used.
fn positions(log: &Log, rows: &Rows, nq: usize, q: usize) -> Vec<f64> {
    rows.runs.iter().flatten().map(|&row| log.theta[row * nq + q]).collect()
}

/// Faults and warnings about the velocities of a log.
pub fn check(model: &Model, log: &Log, rows: &Rows, low_pass: Option<&LowPass>, trim: usize) -> Vec<Finding> {
    let (n, Some(dtheta)) = (model.n(), &log.dtheta) else { return Vec::new() };
    let Some(signals) = Signals::new(model, log, rows, dtheta, low_pass, trim) else { return Vec::new() };
    let names: Vec<&str> = model.velocity_names().collect();
    let size = |x: &[f64]| dot(x, x).sqrt();
    let fastest = signals.slopes.iter().map(|x| size(x)).fold(0.0, f64::max);
    let nq = model.nq();
    let (joints, bodies): (Vec<&Place>, Vec<&Place>) =
        model.configuration_space().places().iter().partition(|place| place.freedom == Freedom::One);
    let moves = |place: &&Place| {
        size(&signals.slopes[place.j]) > SLOW * fastest && !is_at_rest(&positions(log, rows, nq, place.q))
    };
    let (mut lags, mut scales, mut rough) = ((0.0, 0.0), Vec::new(), Vec::new());
    let compared = [&signals.theta[..], &signals.slopes, &signals.logged];
    let of_body = |place: &Place| base_velocity::check(&log.name, names[place.j], place, compared, SLOW * fastest);
    let mut findings: Vec<Finding> = bodies.into_iter().filter_map(of_body).collect();
    let moving: Vec<usize> = joints.into_iter().filter(moves).map(|place| place.j).collect();
    let correlations = each(moving.len(), n * rows.runs.iter().map(Vec::len).sum::<usize>(), |k| {
        let (j, logged) = (moving[k], &signals.logged[moving[k]]);
        let others = moving.iter().filter(|&&i| i != j).map(|&i| (i, correlation(&signals.slopes[i], logged)));
        let best = others.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or((j, 0.0));
        (correlation(&signals.slopes[j], logged), best, correlation(&signals.slopes[j], &signals.forces[j]))
    });
    for (&j, (own, best, by_force)) in moving.iter().zip(correlations) {
        let (slope, logged, name) = (&signals.slopes[j], &signals.logged[j], names[j]);
        let factor = dot(slope, logged) / dot(slope, slope);
        let mut fault = |code, text: String| findings.push(Finding::fault(code, format!("{}: {text}", log.name)));
        if own < -ALIKE {
            fault("sign", format!("the velocity of {name} has the opposite sign of its position's derivative"));
        } else if own.abs() < ALIKE && by_force > ALIKE && by_force > best.1.abs() {
            fault(
                "swapped_columns",
                format!(
                    "the force of {name} is the derivative of its position (correlation {by_force:.3}), its velocity is \
                     not ({own:.3}): the columns of velocity and force (torque) seem to be swapped"
                ),
            );
        } else if own.abs() < ALIKE && best.1.abs() > ALIKE {
            fault(
                "swapped_joints",
                format!(
                    "the velocity of {name} is the derivative of the position of {} (correlation {:.3}), not of its own \
                     ({own:.3})",
                    names[best.0], best.1
                ),
            );
        } else if own < ALIKE {
            fault(
                "velocity",
                format!(
                    "the velocity of {name} is not the derivative of its position (correlation {own:.3}): a desired \
                     velocity, or that of another motion; leave velocities out, then positions are differentiated"
                ),
            );
        } else if !(0.75..1.33).contains(&factor) {
            scales.push((name, factor));
        } else {
            let rest: Vec<f64> = logged.iter().zip(slope).map(|(a, b)| a - b).collect();
            let apart = size(&rest) / size(slope);
            let (along, square) = signals.lag(j);
            let lag = along / square;
            lags = (lags.0 + along, lags.1 + square);
            // a filter delays; only a desired velocity comes before the motion
            let is_early = lag < -(1.5 * rows.step).max(EARLY) && apart > APART / 10.0;
            if is_early || apart > APART {
                let when = match lag < 0.0 {
                    true => "earlier: a desired velocity instead of the measured one?",
                    false => "later: filtered, or that of another motion?",
                };
                fault(
                    if lag < 0.0 { "velocity" } else { "causal_filter" },
                    format!(
                        "the velocity of {name} differs by {:.1} % from its position's derivative, and comes {:.1} ms \
                         {when} Leave velocities out, then positions are differentiated",
                        100.0 * apart,
                        1e3 * lag.abs()
                    ),
                );
            } else if apart > APART / 3.0 {
                rough.push(format!("{name} {:.1} %", 100.0 * apart));
            }
        }
    }
    if !rough.is_empty() {
        findings.push(Finding::warning(
            "velocity",
            format!(
                "{}: velocities differ from the derivatives of positions, beyond the filter ({}): noise or jitter of the \
                 clock, or desired velocities instead of measured ones",
                log.name,
                rough.join(", ")
            ),
        ));
    }
    findings.extend(scale(&log.name, &scales, moving.len()));
    let (along, size) = lags;
    if size > 0.0 && (along / size).abs() > rows.step.max(2e-3) && findings.is_empty() {
        let lag = along / size;
        findings.push(Finding::warning(
            "causal_filter",
            format!(
                "{}: logged velocities come {:.1} ms {} than the derivative of positions: they were filtered causally; \
                 log them unfiltered, or leave them out",
                log.name,
                1e3 * lag.abs(),
                if lag > 0.0 { "later" } else { "earlier" }
            ),
        ));
    }
    findings
}

/// Relative difference, after the filter, above which logged accelerations are not used.
const ACCELERATION_APART: f64 = 0.2;

/// A note if logged accelerations are not the derivatives of the velocities, as those of a driver that writes zeros, or
/// of a sensor.
pub fn accelerations(
    model: &Model,
    log: &Log,
    rows: &Rows,
    low_pass: Option<&LowPass>,
    trim: usize,
) -> Option<Finding> {
    let logged = log.ddtheta.as_ref()?;
    let places = model.configuration_space().places();
    if places.iter().any(|place| place.freedom != Freedom::One) {
        return None;
    }
    let mut signals = Signals::new(model, log, rows, logged, low_pass, trim)?;
    if let Some(dtheta) = &log.dtheta {
        signals.slopes = Signals::new(model, log, rows, dtheta, low_pass, trim)?.logged;
    }
    let size = |x: &[f64]| dot(x, x).sqrt();
    let seconds: Vec<Vec<f64>> = signals.slopes.iter().map(|x| derivative(x, rows.step)).collect();
    let most = seconds.iter().map(|x| size(x)).fold(0.0, f64::max);
    let apart = |j: usize| {
        let rest: Vec<f64> = signals.logged[j].iter().zip(&seconds[j]).map(|(a, b)| a - b).collect();
        size(&rest) / size(&seconds[j])
    };
    let moving = (0..model.n()).filter(|&j| size(&seconds[j]) > SLOW.sqrt() * most).map(|j| (j, apart(j)));
    let (j, worst) = moving.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, worst)| *worst > ACCELERATION_APART)?;
    let name = model.velocity_names().nth(j)?;
    Some(Finding::note(
        "acceleration",
        format!(
            "{}: logged accelerations are not used: that of {name} differs by {:.0} % from the derivative of its velocity",
            log.name,
            100.0 * worst
        ),
    ))
}

/// Velocities in another unit than positions.
fn scale(log: &str, scales: &[(&str, f64)], moving: usize) -> Option<Finding> {
    let (_, first) = scales.first()?;
    let is_near = |x: f64| (0.85..1.18).contains(&(first / x));
    let is_common = moving > 1 && scales.len() == moving && scales.iter().all(|(_, x)| (x / first - 1.0).abs() < 0.02);
    const NAME_IT: &str = "Name the unit in the header, such as q1_deg";
    let (unit, remedy) = match () {
        () if is_near(57.2958) => (": velocities in deg/s, positions in rad?", NAME_IT),
        () if is_near(1.0 / 57.2958) => (": positions in degrees, velocities in rad/s?", NAME_IT),
        () if is_near(9.5493) => (": velocities in rpm?", NAME_IT),
        () if is_near(1e3) || is_near(1e6) || is_near(1e9) => (": times in ms, µs or ns?", NAME_IT),
        () if is_near(1e-3) => (": velocities per ms, or in mrad/s?", NAME_IT),
        () if is_common => {
            (", the same for all joints: is t a count of rows, or in another unit than s?", "Log seconds")
        }
        () => (": another unit, or the motor's side of a gear?", NAME_IT),
    };
    let list: Vec<String> = scales.iter().map(|(name, factor)| format!("{name} {factor:.4}")).collect();
    Some(Finding::fault(
        "unit",
        format!(
            "{log}: velocities are not the derivatives of positions but a multiple of them ({}){unit} \
             {remedy}",
            list.join(", ")
        ),
    ))
}
