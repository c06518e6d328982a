//! Mistakes in a log that the robot's own values reveal: joints mixed up, signs, units, the direction of gravity.

use crate::signals::{Samples, derivative};
use crate::{Error, Finding, Log, Rows};
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Environment, Freedom, Model, Vec3, fast};

/// The logarithms of the joints' squared errors must fall by this much in all before a mistake is reported.
const CLEAR: f64 = 1.5;

/// Samples that are compared.
const COMPARED: usize = 400;

/// A mistake that may have been made.
#[derive(Clone, Debug)]
enum Mistake {
    None,
    SwappedForces(usize, usize),
    SwappedMotions(usize, usize),
    SwappedJoints(usize, usize),
    ForceSign(usize),
    MotionSign(usize),
    JointSign(usize),
    ForceUnit(f64),
    Degrees,
    Gravity([f64; 3]),
    ForceOffBy(f64),
}

/// Compares the log with the robot's own prediction under each possible mistake, and reports the one that explains it
/// far better than none. Only joints of one axis are compared.
///
/// # Errors
/// [`Error::Model`].
pub fn mistakes(model: &Model, samples: &Samples) -> Result<Vec<Finding>, Error> {
    let places = model.configuration_space().places();
    if places.iter().any(|place| place.freedom != Freedom::One) || samples.count() < 20 {
        return Ok(Vec::new());
    }
    let n = model.n();
    let names: Vec<&str> = model.velocity_names().collect();
    let mut all = Vec::new();
    for a in 0..n {
        all.extend([Mistake::ForceSign(a), Mistake::MotionSign(a), Mistake::JointSign(a)]);
        for b in a + 1..n {
            all.extend([Mistake::SwappedForces(a, b), Mistake::SwappedMotions(a, b), Mistake::SwappedJoints(a, b)]);
        }
    }
    all.extend([Mistake::ForceUnit(1e-3), Mistake::ForceUnit(1e-2), Mistake::ForceUnit(1e3), Mistake::Degrees]);
    all.push(Mistake::ForceOffBy(-1.0));
    let g = model.gravity().0;
    let size = Vec3(g).norm();
    if size > 0.0 {
        let directions = (0..3).flat_map(|axis| {
            [1.0, -1.0].map(|sign| core::array::from_fn(|i| if i == axis { sign * size } else { 0.0 }))
        });
        all.extend(directions.filter(|d: &[f64; 3]| Vec3(*d).dot(Vec3(g)) < 0.99 * size * size).map(Mistake::Gravity));
    }
    let mut comparison = Comparison::new(model, samples);
    let as_it_is = comparison.score(&Mistake::None);
    let (mut best, mut least) = (Mistake::None, as_it_is);
    for mistake in all {
        let score = comparison.score(&mistake);
        if score < least {
            (best, least) = (mistake, score);
        }
    }
    if !(as_it_is - least > CLEAR) {
        return Ok(Vec::new());
    }
    let share = |score: f64| 100.0 * (score / n as f64).exp();
    let gain = format!(
        "then the robot's own values leave {:.2} % of each force's variance unexplained, now {:.2} % (geometric means)",
        share(least),
        share(as_it_is)
    );
    let (code, text) = match best {
        Mistake::None => return Ok(Vec::new()),
        Mistake::SwappedForces(a, b) => {
            ("swapped_joints", format!("the forces of {} and {} seem to be swapped", names[a], names[b]))
        }
        Mistake::SwappedMotions(a, b) => {
            ("swapped_joints", format!("the positions of {} and {} seem to be swapped", names[a], names[b]))
        }
        Mistake::SwappedJoints(a, b) => {
            ("swapped_joints", format!("the columns of {} and {} seem to be swapped", names[a], names[b]))
        }
        Mistake::ForceSign(a) => ("sign", format!("the force of {} seems to have the opposite sign", names[a])),
        Mistake::MotionSign(a) => {
            ("sign", format!("position and velocity of {} seem to have the opposite sign", names[a]))
        }
        Mistake::JointSign(a) => ("sign", format!("all columns of {} seem to have the opposite sign", names[a])),
        Mistake::ForceOffBy(_) => ("sign", "all forces seem to have the opposite sign".to_string()),
        Mistake::ForceUnit(factor) => {
            ("unit", format!("forces seem to be in another unit than N m: times {factor} they would fit"))
        }
        Mistake::Degrees => ("unit", "positions and velocities seem to be in degrees, expected rad".to_string()),
        Mistake::Gravity(g) => {
            ("gravity", format!("gravity seems to be {g:?} m/s² in the base frame, not {:?}", model.gravity().0))
        }
    };
    Ok(vec![Finding::warning(code, format!("{text}; {gain}"))])
}

struct Comparison<'a> {
    model: &'a Model,
    samples: &'a Samples,
    rows: Vec<usize>,
    workspace: fast::Workspace,
}

impl<'a> Comparison<'a> {
    fn new(model: &'a Model, samples: &'a Samples) -> Self {
        let step = samples.count().div_ceil(COMPARED);
        let rows = (0..samples.count()).step_by(step).collect();
        Comparison { model, samples, rows, workspace: fast::Workspace::new(model) }
    }

    /// Σ_j log of the share of force j that the robot, with friction and an offset fitted, does not predict.
    fn score(&mut self, mistake: &Mistake) -> f64 {
        let n = self.model.n();
        let query = Query::from(InverseDynamics);
        let mut environment = self.model.environment();
        if let Mistake::Gravity(g) = mistake {
            environment = Environment { gravity: Vec3(*g), ..environment };
        }
        let mut sums = vec![Fit::default(); n];
        let mut predicted = vec![0.0; n];
        for &k in &self.rows {
            let row = |table: &[f64]| table[k * n..(k + 1) * n].to_vec();
            let mut motion = [row(&self.samples.theta), row(&self.samples.dtheta), row(&self.samples.ddtheta)];
            let mut tau = row(&self.samples.tau);
            correct(mistake, &mut motion, &mut tau);
            let [theta, dtheta, ddtheta] = &motion;
            let inputs: [&[f64]; 3] = [theta, dtheta, ddtheta];
            fast::evaluate(&query, self.model, &inputs, &environment, &mut self.workspace, &mut [&mut predicted]);
            for j in 0..n {
                sums[j].add(tau[j], predicted[j], dtheta[j]);
            }
        }
        sums.iter().map(|fit| fit.unexplained().max(1e-12).ln()).sum()
    }
}

fn correct(mistake: &Mistake, motion: &mut [Vec<f64>; 3], tau: &mut [f64]) {
    match *mistake {
        Mistake::None | Mistake::Gravity(_) => {}
        Mistake::SwappedForces(a, b) => tau.swap(a, b),
        Mistake::SwappedMotions(a, b) => motion.iter_mut().for_each(|x| x.swap(a, b)),
        Mistake::SwappedJoints(a, b) => {
            motion.iter_mut().for_each(|x| x.swap(a, b));
            tau.swap(a, b);
        }
        Mistake::ForceSign(a) => tau[a] = -tau[a],
        Mistake::MotionSign(a) => motion.iter_mut().for_each(|x| x[a] = -x[a]),
        Mistake::JointSign(a) => {
            motion.iter_mut().for_each(|x| x[a] = -x[a]);
            tau[a] = -tau[a];
        }
        Mistake::ForceUnit(factor) | Mistake::ForceOffBy(factor) => tau.iter_mut().for_each(|x| *x *= factor),
        Mistake::Degrees => motion.iter_mut().flatten().for_each(|x| *x = x.to_radians()),
    }
}

/// τ − τ̂ = d θ̇ + μ tanh(θ̇/0.05) + o, with d, μ ≥ 0.
#[derive(Clone, Debug, Default)]
struct Fit {
    count: f64,
    force: [f64; 2],
    /// Moments of (1, θ̇, tanh, e) about 0.
    moments: [[f64; 4]; 4],
}

impl Fit {
    fn add(&mut self, tau: f64, predicted: f64, dtheta: f64) {
        self.count += 1.0;
        self.force[0] += tau;
        self.force[1] += tau * tau;
        let x = [1.0, dtheta, (dtheta / 0.05).tanh(), tau - predicted];
        for i in 0..4 {
            for j in 0..4 {
                self.moments[i][j] += x[i] * x[j];
            }
        }
    }

    /// The share of the force's variance that is left.
    fn unexplained(&self) -> f64 {
        let N = self.count;
        let variance = self.force[1] - self.force[0] * self.force[0] / N;
        // covariances remove the offset
        let c = |i: usize, j: usize| self.moments[i][j] - self.moments[0][i] * self.moments[0][j] / N;
        let (vv, vs, ss, ve, se, ee) = (c(1, 1), c(1, 2), c(2, 2), c(1, 3), c(2, 3), c(3, 3));
        let mut least = ee;
        let mut try_one = |d: f64, mu: f64| {
            if d >= 0.0 && mu >= 0.0 {
                let left = ee - 2.0 * (d * ve + mu * se) + d * d * vv + 2.0 * d * mu * vs + mu * mu * ss;
                least = least.min(left);
            }
        };
        if vv > 0.0 {
            try_one(ve / vv, 0.0);
        }
        if ss > 0.0 {
            try_one(0.0, se / ss);
        }
        let det = vv * ss - vs * vs;
        if det > 1e-9 * vv * ss {
            try_one((ve * ss - se * vs) / det, (se * vv - ve * vs) / det);
        }
        if variance > 0.0 { (least / variance).max(0.0) } else { 1.0 }
    }
}

/// Compares logged velocities with differentiated positions: signs, units, mixed-up joints, and delays of filters that
/// ran forwards only.
pub fn velocities(model: &Model, log: &Log, rows: &Rows) -> Vec<Finding> {
    let (n, Some(dtheta)) = (model.n(), &log.dtheta) else { return Vec::new() };
    let places = model.configuration_space().places();
    if places.iter().any(|place| place.freedom != Freedom::One) {
        return Vec::new();
    }
    let Some(run) = rows.runs.iter().max_by_key(|run| run.len()) else { return Vec::new() };
    let names: Vec<&str> = model.velocity_names().collect();
    let column = |table: &[f64], j: usize| -> Vec<f64> { run.iter().map(|&row| table[row * n + j]).collect() };
    let slopes: Vec<Vec<f64>> = (0..n).map(|j| derivative(&column(&log.theta, j), rows.step)).collect();
    let logged: Vec<Vec<f64>> = (0..n).map(|j| column(dtheta, j)).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut findings, mut lags) = (Vec::new(), Vec::new());
    for j in 0..n {
        let square = dot(&slopes[j], &slopes[j]);
        if !(square > 0.0) {
            continue;
        }
        let correlation = |i: usize| {
            let size = (dot(&slopes[i], &slopes[i]) * dot(&logged[j], &logged[j])).sqrt();
            if size > 0.0 { dot(&slopes[i], &logged[j]) / size } else { 0.0 }
        };
        let (own, factor) = (correlation(j), dot(&slopes[j], &logged[j]) / square);
        let best = (0..n).max_by(|&a, &b| correlation(a).abs().total_cmp(&correlation(b).abs())).unwrap_or(j);
        let name = names[j];
        let text = if own < -0.8 {
            Some(("sign", format!("the velocity of {name} has the opposite sign of its position's derivative")))
        } else if own.abs() < 0.5 && best != j && correlation(best).abs() > 0.8 {
            Some((
                "swapped_joints",
                format!("the velocity of {name} is the derivative of the position of {}", names[best]),
            ))
        } else if own > 0.8 && !(0.7..1.4).contains(&factor) {
            let unit = if (40.0..80.0).contains(&factor) { ", deg/s against rad" } else { "" };
            Some(("unit", format!("the velocity of {name} is {factor:.3} times its position's derivative{unit}")))
        } else {
            None
        };
        if let Some((code, text)) = text {
            findings.push(Finding::warning(code, format!("{}: {text}", log.name)));
        } else if own > 0.8 {
            // θ̇(t − δ) ≈ θ′ − δ θ″
            let second = derivative(&slopes[j], rows.step);
            let rest: Vec<f64> = logged[j].iter().zip(&slopes[j]).map(|(a, b)| a - b).collect();
            let size = dot(&second, &second);
            lags.push((-dot(&rest, &second), size));
        }
    }
    let (along, size) = lags.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    if size > 0.0 && (along / size).abs() > rows.step.max(2e-3) {
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
