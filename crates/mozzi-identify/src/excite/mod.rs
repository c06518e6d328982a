//! Motions that determine a robot's parameters, within limits.

mod basis;
pub mod lbfgs;
mod limits;
mod objective;
#[cfg(test)]
mod tests;

pub use basis::Basis;
pub use limits::{Box3, MotionLimits, Sphere};
pub use objective::Goal;

use crate::columns::Columns;
use crate::compress::stacked;
use crate::setup::without_constraints;
use crate::{Choice, Error};
use mozzi::random::Random;
use mozzi::{BaseParameters, Freedom, Model};
use objective::Objective;

/// Options of the search for an exciting motion.
#[derive(Clone, Debug)]
pub struct ExciteOptions {
    /// Duration of the motion, s.
    pub duration: f64,
    /// Harmonics of the Fourier series.
    pub harmonics: usize,
    /// The largest determinant of the information, or the least condition number.
    pub goal: Goal,
    /// Limits of the motion.
    pub limits: MotionLimits,
    /// The parameters that are to be estimated.
    pub choice: Choice,
    /// Standard deviation of each force's noise, N m or N, for the predicted confidence.
    pub noise: Vec<f64>,
    /// Independent samples per second of the later log.
    pub rate: f64,
    /// Where the motion begins, n numbers; the middle of the limits by default.
    pub start: Option<Vec<f64>>,
    /// Iterations, at most, of each of the three searches.
    pub iterations: usize,
    /// Random starts, of which the best is kept.
    pub starts: usize,
}

impl ExciteOptions {
    /// A motion of this duration for a robot: its own limits, 1 % of each effort limit as noise.
    pub fn new(model: &Model, duration: f64) -> Self {
        let limits = MotionLimits::of(model);
        let noise = noise(&limits.torque);
        ExciteOptions {
            duration,
            harmonics: 5,
            goal: Goal::LogDet,
            limits,
            choice: Choice::default(),
            noise,
            rate: 100.0,
            start: None,
            iterations: 60,
            starts: 2,
        }
    }
}

/// The usual noise of forces: 1 % of each torque limit, 0.1 N m or N if there is none.
pub fn noise(torque: &[f64]) -> Vec<f64> {
    torque.iter().map(|t| if t.is_finite() { 0.01 * t } else { 0.1 }).collect()
}

/// A motion and what it will determine.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// Its basis.
    pub basis: Basis,
    /// Coefficients, by joint.
    pub coefficients: Vec<f64>,
    /// The condition number of the weighted base regressor with unit columns.
    pub condition: f64,
    /// The condition number of the first random motion within the limits, for comparison.
    pub condition_of_random: f64,
    /// Base parameters: names, the robot's values, and the standard deviations that a log of this motion will give.
    pub parameters: Vec<(String, f64, f64)>,
    /// Whether it was stopped early.
    pub is_stopped: bool,
}

impl Excitation {
    /// θ, θ̇ and θ̈ at a time.
    pub fn at(&self, t: f64) -> [Vec<f64>; 3] {
        state(&self.basis, &self.coefficients, t)
    }
}

/// θ, θ̇ and θ̈ of coefficients at a time.
fn state(basis: &Basis, coefficients: &[f64], t: f64) -> [Vec<f64>; 3] {
    let shares = basis.at(t);
    let n = coefficients.len() / basis.count();
    let sum = |j: usize, order: usize| {
        coefficients[j * basis.count()..][..basis.count()].iter().zip(&shares).map(|(c, s)| c * s[order]).sum()
    };
    core::array::from_fn(|order| (0..n).map(|j| sum(j, order)).collect())
}

/// Searches a motion. `stop` ends the search with the best so far.
///
/// # Errors
/// [`Error::BadOption`] for a duration or a rate that is not positive, a negative radius, no joint that moves, limits
/// of a wrong length, a start at which a limit is broken, or limits that leave no room for a motion.
pub fn excite(model: &Model, options: &ExciteOptions, stop: &dyn Fn() -> bool) -> Result<Excitation, Error> {
    without_constraints(model)?;
    check(model, options)?;
    let columns = Columns::new(model, Choice { apparent: false, gains: false, ..options.choice.clone() })?;
    let (P, n) = (columns.count(), model.n());
    let names = columns.unknowns.iter().map(|unknown| unknown.name.clone()).collect();
    let base = BaseParameters::of_columns(&stacked(&columns, 2 * P / n + 10)?, names);
    let basis = Basis { duration: options.duration, harmonics: options.harmonics };
    let mut objective = Objective::new(&columns, &base, &basis, options)?;
    let middle = objective.start()?;
    let moves: Vec<bool> = options.limits.position.iter().map(|[low, high]| low < high).collect();
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut condition_of_random = f64::INFINITY;
    for seed in 0..options.starts.max(1) {
        let mut random = Random(17 + seed as u64);
        let mut c = vec![0.0; n * basis.count()];
        for j in 0..n {
            c[j * basis.count()] = middle[j];
            let most = if moves[j] { options.limits.velocity[j] } else { 0.0 };
            let size = most * options.duration / (12.0 * options.harmonics as f64);
            for k in 1..basis.count() {
                c[j * basis.count() + k] = size * random.next() / (1.0 + (k / 2) as f64).sqrt();
            }
        }
        objective.shrink(&mut c, &middle);
        if seed == 0 {
            condition_of_random = objective.condition(&c);
        }
        let hold = options.start.is_some();
        // a condition number has many local minima: one near the smallest ellipsoid is sought, and none worse is taken
        let stages: &[Goal] = match options.goal {
            Goal::LogDet => &[Goal::LogDet],
            Goal::Condition => &[Goal::LogDet, Goal::Condition],
        };
        for &stage in stages {
            objective.goal = stage;
            for weight in [10.0, 100.0, 1000.0] {
                let f = |c: &[f64]| {
                    let (value, mut gradient) = objective.value(c, weight);
                    for (of_joint, moves) in gradient.chunks_mut(basis.count()).zip(&moves) {
                        let held = if *moves { usize::from(hold) } else { of_joint.len() };
                        of_joint[..held].fill(0.0);
                    }
                    (value, gradient)
                };
                lbfgs::minimize(&mut c, options.iterations, 1e-5, 0.1, f, stop);
            }
            let is_inside = objective.shrink(&mut c, &middle);
            let value = match options.goal {
                Goal::LogDet => objective.value(&c, 0.0).0,
                Goal::Condition => objective.condition(&c),
            };
            if is_inside && best.as_ref().is_none_or(|(least, _)| least.is_nan() || value < *least) {
                best = Some((value, c.clone()));
            }
        }
        if stop() {
            break;
        }
    }
    let (_, coefficients) = best.ok_or_else(|| Error::BadOption {
        option: "the start",
        found: format!("{middle:.4?}, about which every motion breaks a limit"),
        expected: "a start with room for a motion".into(),
    })?;
    let deviations = objective.deviations(&coefficients);
    let values = base.values(&columns.prior());
    let parameters = base.names().into_iter().zip(values.iter().copied()).zip(deviations);
    Ok(Excitation {
        condition: objective.condition(&coefficients),
        condition_of_random,
        parameters: parameters.map(|((name, value), deviation)| (name, value, deviation)).collect(),
        basis,
        coefficients,
        is_stopped: stop(),
    })
}

fn check(model: &Model, options: &ExciteOptions) -> Result<(), Error> {
    let n = model.n();
    let wrong = |option: &'static str, found: String, expected: &str| {
        Err(Error::BadOption { option, found, expected: expected.into() })
    };
    if !model.configuration_space().places().iter().all(|place| place.freedom == Freedom::One) {
        return wrong("the robot", "a floating base or a ball".into(), "a fixed base and joints of one axis");
    }
    if !(options.duration > 0.0 && options.duration.is_finite()) {
        return wrong("the duration", format!("{} s", options.duration), "a positive number of seconds");
    }
    if !(options.rate > 0.0 && options.rate.is_finite()) {
        return wrong("the rate", format!("{} Hz", options.rate), "a positive number of samples per second");
    }
    if options.harmonics == 0 || options.harmonics > 50 {
        return wrong("harmonics", options.harmonics.to_string(), "1 to 50");
    }
    let limits = &options.limits;
    let lengths = [
        limits.position.len(),
        limits.velocity.len(),
        limits.acceleration.len(),
        limits.torque.len(),
        options.noise.len(),
    ];
    if lengths.iter().any(|&length| length != n) {
        return wrong("limits and noise", format!("of lengths {lengths:?}"), "one number for each joint");
    }
    if !limits.position.iter().any(|[low, high]| low < high) {
        return wrong("the range of every joint", "0".into(), "a joint that moves");
    }
    let radii = limits.apart.iter().flat_map(|(a, b)| [a.radius, b.radius]);
    if let Some(radius) = radii.into_iter().find(|radius| !(*radius >= 0.0 && radius.is_finite())) {
        return wrong("a radius", format!("{radius} m"), "0 or more");
    }
    if !options.noise.iter().all(|x| *x > 0.0 && x.is_finite()) {
        return wrong("the noise", format!("{:?}", options.noise), "positive numbers");
    }
    if let Some((joint, x)) = model.joint_names().zip(&limits.velocity).find(|(_, x)| x.is_infinite()) {
        return wrong("a limit of velocity", format!("{x} for `{joint}`"), "a finite number");
    }
    for (option, list) in [
        ("a limit of velocity", &limits.velocity),
        ("a limit of acceleration", &limits.acceleration),
        ("a limit of torque", &limits.torque),
    ] {
        if let Some((joint, x)) = model.joint_names().zip(list).find(|(_, x)| !(**x > 0.0)) {
            return wrong(option, format!("{x} for `{joint}`"), "a positive number");
        }
    }
    if let Some(start) = &options.start
        && start.len() != n
    {
        return wrong("the start", format!("{start:?}"), "one number for each joint");
    }
    Ok(())
}
