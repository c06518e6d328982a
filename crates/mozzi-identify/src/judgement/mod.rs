//! How good an identification is: predictions on what was left out first, then parameters.

mod base_velocity;
pub mod determined;
pub mod excitation;
mod gains;
mod lag;
pub(crate) mod limits;
mod mistake;
mod refit;
pub mod residuals;
pub(crate) mod rest;
pub mod sensor;
pub(crate) mod short;
pub mod suspicion;
pub mod velocities;

use crate::signals::Samples;
use crate::{Columns, Error, Finding, Identification, Kind, Log, Servo, servos};
use determined::{Standing, standings};
use excitation::Parameter;
use residuals::Residual;

/// Everything that a report shows beside the errors.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// By log, then by force: what is left of it, where each block of time is predicted by a fit without it.
    pub residuals: Vec<Vec<Residual>>,
    /// By log: forces predicted in that way, N × n.
    pub predicted: Vec<Vec<f64>>,
    /// Base parameters.
    pub parameters: Vec<Parameter>,
    /// Position controllers, if targets were logged.
    pub servos: Vec<Servo>,
    /// By unknown: whether the data determines it.
    pub standings: Vec<Standing>,
    /// Mistakes in the logs, and effects that the model lacks.
    pub findings: Vec<Finding>,
}

/// Judges an identification from these logs.
///
/// # Errors
/// [`Error::Model`].
pub fn judge(found: &Identification<'_>, logs: &[Log]) -> Result<Judgement, Error> {
    let columns = &found.setup.columns;
    let model = columns.model;
    let n = model.n();
    let names: Vec<&str> = model.velocity_names().collect();
    let (mut residuals, mut predicted, mut findings) = (Vec::new(), Vec::new(), Vec::new());
    for (samples, log) in found.samples.iter().zip(logs) {
        let of_log = found.predicted_unseen(samples)?;
        let all: Vec<Residual> = (0..n).map(|j| Residual::new(names[j], j, n, samples, &of_log)).collect();
        let above_rounding = residuals::above_rounding(&all);
        let refitted = refit::check(found, &log.name, samples);
        if refitted.is_none() {
            findings.extend(lag::check(&log.name, &above_rounding, 1.0 / samples.rate));
        }
        findings.extend(refitted);
        findings.extend(colour(&log.name, &above_rounding, samples.count() as f64 * samples.independent()));
        findings.extend(unexplained(&log.name, &all));
        findings.extend(blunted(&log.name, samples, columns));
        residuals.push(all);
        predicted.push(of_log);
    }
    let parameters = excitation::parameters(found)?;
    let weak = parameters.iter().filter(|parameter| parameter.is_weak()).count();
    if weak > 0 {
        findings.push(Finding::note(
            "not_excited",
            format!(
                "{weak} of {} base parameters have a standard deviation larger than their value and 1 % of the forces",
                parameters.len()
            ),
        ));
    }
    // a fit without armature may fail, which is no finding
    findings.extend(sensor::behind_the_gears(found).ok().flatten());
    let condition = found.estimates.least_squares.condition;
    if condition > 300.0 {
        findings.push(Finding::warning(
            "condition",
            format!(
                "the equations' condition number is {condition:.0} (below 100 is good): move joints more, or longer"
            ),
        ));
    }
    for name in &found.setup.repaired {
        findings.push(Finding::note(
            "thin_prior",
            format!("the robot's own inertia of {name} is massless or thinner than 5 mm; its prior is 1 cm thick"),
        ));
    }
    findings.extend(apparent(found));
    findings.extend(impossible(found));
    let standings = standings(found, &parameters);
    let servos = match model.configuration_space().is_flat() {
        true => servos(&names, &found.samples, &gains(found)),
        false => Vec::new(),
    };
    findings.extend(unlike_a_servo(&servos));
    Ok(Judgement { servos, residuals, predicted, parameters, standings, findings })
}

/// N m or N of one unit of each force: the drive gains, if currents were logged.
fn gains(found: &Identification<'_>) -> Vec<f64> {
    let columns = &found.setup.columns;
    let x = &found.estimates.consistent.x;
    (0..columns.model.n()).map(|j| columns.index(Kind::Gain(j)).map_or(1.0, |k| x[k])).collect()
}

/// Joints whose forces are no function of target, position and velocity as in a PD law.
fn unlike_a_servo(servos: &[Servo]) -> Option<Finding> {
    /// A larger error over force.
    const UNLIKE: f64 = 0.3;
    let is_unlike = |servo: &&Servo| servo.nrms > UNLIKE || servo.stiffness[0] <= 0.0;
    let bad: Vec<String> =
        servos.iter().filter(is_unlike).map(|servo| format!("{} ({:.0} %)", servo.joint, 100.0 * servo.nrms)).collect();
    (!bad.is_empty()).then(|| {
        Finding::warning(
            "no_servo",
            format!(
                "kp (θ*(t − δ) − θ) − kd θ̇ + b does not explain the forces of {}: an integrator, feed-forward, saturation \
                 or another controller; their gains mean little",
                bad.join(", ")
            ),
        )
    })
}

/// Inertia and damping that predictions contain and no robot has.
fn apparent(found: &Identification<'_>) -> Option<Finding> {
    /// A smaller share of a joint's force is not worth a word.
    const SHARE: f64 = 0.01;
    let (columns, optimum) = (&found.setup.columns, &found.estimates.consistent);
    let evidence = found.evidence();
    let (force, written) = (evidence.rms(), &found.fitted.written);
    let names: Vec<&str> = columns.model.velocity_names().collect();
    let is_there = |j: usize| (written[j] - found.fitted.consistent[j]) > SHARE * force[j];
    let joints: Vec<&str> = (0..names.len()).filter(|&j| is_there(j)).map(|j| names[j]).collect();
    let has_any = optimum.apparent.iter().any(|x| *x != 0.0);
    (has_any && !joints.is_empty()).then(|| {
        Finding::note(
            "apparent",
            format!(
                "the forces of {} contain what acts like an inertia or a damping that no robot has: friction with \
                 memory or that falls with speed, or a delay; predictions contain it, the written robot does not",
                joints.join(", ")
            ),
        )
    })
}

/// Forces that bodies which exist explain much worse than least squares does.
fn impossible(found: &Identification<'_>) -> Option<Finding> {
    /// Errors larger than those of least squares by this factor, and than this part of the forces.
    const WORSE: (f64, f64) = (2.0, 0.01);
    let (errors, columns) = (&found.fitted, &found.setup.columns);
    if columns.bodies().is_empty() || found.estimates.consistent.is_astray {
        return None;
    }
    let [exists, least] = [&errors.consistent, &errors.least_squares].map(|list| errors.normalized(list));
    if exists < WORSE.0 * least || exists < WORSE.1 {
        return None;
    }
    let payload = columns.index(Kind::Payload(0)).filter(|&k| found.setup.alone(k).is_some());
    let why = match payload.map(|k| found.estimates.least_squares.x[k]).filter(|mass| *mass < 0.0) {
        Some(mass) => format!("with a payload of {mass:.3} kg: something in the robot's file is not mounted"),
        None => "with bodies that do not: the robot's file, a column or a unit is wrong, or --prior is large".into(),
    };
    let percent = |x: f64| 100.0 * x;
    Some(Finding::warning(
        "impossible_bodies",
        format!(
            "bodies that exist explain the forces to {:.1} %, least squares to {:.1} %, {why}",
            percent(exists),
            percent(least)
        ),
    ))
}

/// Friction of velocities that were not logged.
fn blunted(log: &str, samples: &Samples, columns: &Columns<'_>) -> Option<Finding> {
    let has_friction = columns.unknowns.iter().any(|unknown| matches!(unknown.kind, Kind::Coulomb(_)));
    let cutoff = samples.cutoff.filter(|_| samples.coulomb.is_none() && has_friction)?;
    Some(Finding::note(
        "no_velocities",
        format!(
            "{log}: without logged velocities, the cut-off of {cutoff:.3} Hz blunts the jump of dry friction at reversals, \
             whose μ comes out too small and damping too large; log velocities, or raise --cutoff"
        ),
    ))
}

/// Residuals that are no noise make deviations too small.
fn colour(log: &str, residuals: &[Residual], independent: f64) -> Option<Finding> {
    /// That of noise is within two of its deviations, 1/√N of N independent samples.
    const HIGH: f64 = 0.5;
    let high = HIGH + 2.0 / independent.max(1.0).sqrt();
    let coloured: Vec<&Residual> = residuals.iter().filter(|r| r.autocorrelation > high).collect();
    let most = coloured.iter().map(|r| r.autocorrelation).fold(0.0, f64::max).min(0.99);
    let factor = coloured.iter().map(|r| r.colour()).fold(1.0, f64::max);
    (!coloured.is_empty()).then(|| {
        let names: Vec<&str> = coloured.iter().map(|r| r.name.as_str()).collect();
        Finding::note(
            "coloured_residuals",
            format!(
                "{log}: residuals of {} are no noise but effects that the model lacks (autocorrelation \
                 up to {most:.2}): \
                 standard deviations are too small, by up to {factor:.0} times",
                names.join(", ")
            ),
        )
    })
}

/// Joints whose residual stays above half their force.
fn unexplained(log: &str, residuals: &[Residual]) -> Option<Finding> {
    const SHARE: f64 = 0.5;
    let most = residuals.iter().map(|r| r.force).fold(0.0, f64::max);
    let bad: Vec<String> = residuals
        .iter()
        .filter(|r| r.rmse > SHARE * r.force && r.force > 1e-3 * most)
        .map(|r| format!("{} ({:.0} %)", r.name, 100.0 * r.rmse / r.force))
        .collect();
    (!bad.is_empty()).then(|| {
        Finding::warning(
            "unexplained",
            format!(
                "{log}: most of the force is not explained at {}: friction with memory or that depends on load, a joint \
                 that hardly moves, joints that share a motor or a gear (a coupled wrist), a wrong axis in the robot's \
                 file, or a column of another joint",
                bad.join(", ")
            ),
        )
    })
}
