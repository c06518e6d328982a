//! Refinement on rollouts: the parameters that predict motion, not only forces.

use crate::columns::Kind;
use crate::compress::PARTS;
use crate::estimate::consistent::Newton;
use crate::excite::lbfgs;
use crate::payload::robot_of;
use crate::predict::parameters;
use crate::signals::Samples;
use crate::{Error, Identification};
use mozzi::Model;
use mozzi_sim::{Friction, Method, Rollout};
use nalgebra::DVector;

/// How rollouts are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefineOptions {
    /// The duration of each window, s.
    pub window: f64,
    /// Windows, at most, spread evenly over the logs.
    pub windows: usize,
    /// Iterations, at most.
    pub iterations: usize,
}

impl Default for RefineOptions {
    /// 30 windows of 0.3 s.
    fn default() -> Self {
        RefineOptions { window: 0.3, windows: 30, iterations: 20 }
    }
}

/// Result of the refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// The unknowns.
    pub x: Vec<f64>,
    /// Root mean square errors of positions and of velocities in the windows, by joint, before.
    pub before: [Vec<f64>; 2],
    /// Root mean square errors after the refinement.
    pub after: [Vec<f64>; 2],
}

/// A stretch of a log.
struct Window<'s> {
    samples: &'s Samples,
    first: usize,
    /// The measured forces without those of measured wrenches, by rows.
    tau: Vec<f64>,
}

impl<'s> Window<'s> {
    fn new(model: &Model, samples: &'s Samples, first: usize, length: usize) -> Result<Self, Error> {
        let (n, mut tau) = (model.n(), Vec::new());
        for k in first..=first + length {
            let row = k * n..(k + 1) * n;
            let JtF = model.tip_forces(&samples.theta[row.clone()], &samples.applied(k))?;
            tau.extend(samples.tau[row].iter().zip(&JtF).map(|(tau, JtF)| tau - JtF));
        }
        Ok(Window { samples, first, tau })
    }
}

/// Minimizes, on the fitted part of the logs, the cost of the equations and the prior plus the squared errors of
/// rollouts, relative to their size at the start: the forces that were measured drive the robot from a measured state,
/// and its motion is compared with the measured one, where no force is saturated. Gradients are those of the discrete
/// steps, by the adjoint; the links stay bodies that can exist.
///
/// # Errors
/// [`Error::BadOption`] for a floating base or a ball, a payload, Stribeck friction, drive gains, or a window longer
/// than the logs; [`Error::Model`] if M is singular.
pub fn refine(
    found: &Identification<'_>,
    options: &RefineOptions,
    stop: &dyn Fn() -> bool,
) -> Result<Refinement, Error> {
    let columns = &found.setup.columns;
    let (model, choice) = (columns.model, &columns.choice);
    let wrong = |found: &str, expected: &str| Error::BadOption {
        option: "refinement on rollouts",
        found: found.into(),
        expected: expected.into(),
    };
    if !model.configuration_space().is_flat() {
        return Err(wrong("a floating base or a ball", "joints of one axis on a fixed base"));
    }
    if choice.payload.is_some() || choice.stribeck.is_some() || choice.gains {
        return Err(wrong(
            "a payload, Stribeck friction or drive gains",
            "links, friction, armature, springs and offsets",
        ));
    }
    if !columns.rotors.is_empty() {
        return Err(wrong("a rotor that several joints turn", "rotors of one joint each"));
    }
    let mut windows = Vec::new();
    for samples in &found.samples {
        let length = (options.window * samples.rate).round() as usize;
        let is_whole = |first: usize| {
            let jumps = samples.t[first + length] - samples.t[first] > 1.01 * length as f64 / samples.rate;
            !jumps && !samples.is_valid[first * model.n()..(first + length + 1) * model.n()].contains(&false)
        };
        let fitted = found.tenths() * samples.count() / PARTS;
        let starts = (0..fitted.saturating_sub(length)).step_by(length.max(1));
        windows.extend(starts.filter(|&first| is_whole(first)).map(|first| (samples, first, length)));
    }
    if windows.is_empty() || options.windows == 0 {
        let expected = "shorter than the fitted parts of the logs without gaps and saturated forces";
        return Err(wrong(&format!("windows of {} s", options.window), expected));
    }
    let step = windows.len().div_ceil(options.windows);
    let windows = windows.into_iter().step_by(step);
    let windows = windows.map(|(samples, first, length)| Window::new(model, samples, first, length));
    let windows: Vec<Window> = windows.collect::<Result<_, _>>()?;

    let data = found.evidence().weighted(&found.estimates.least_squares.sigma);
    let problem = found.setup.problem.of_robot();
    let newton = Newton::new(&problem, &data);
    let gamma = found.setup.problem.gamma;
    let singular = || Error::NotExciting { reason: "the equations are singular".into() };
    let mut inside = found.estimates.consistent.x.clone();
    problem.positive.iter().for_each(|&k| inside[k] = inside[k].max(1e-6));
    let start = newton.whitened(&inside).ok_or_else(singular)?;
    let S = newton.directions(&start, gamma)?;
    let mut rollouts = Rollouts { found, windows, window: options.window, sizes: None };
    let before = rollouts.errors(&found.estimates.consistent.x)?;
    rollouts.sizes = Some(before.clone().map(|list| list.iter().map(|x| x.max(1e-9)).collect()));
    let mut failure = None;
    let mut u = vec![0.0; start.len()];
    let objective = |u: &[f64]| -> (f64, Vec<f64>) {
        let y = &start + &S * DVector::from_column_slice(u);
        let cost = newton.cost(&y, gamma);
        if !cost.is_finite() {
            return (f64::INFINITY, vec![0.0; u.len()]);
        }
        let x: Vec<f64> = (&newton.T * &y).iter().copied().collect();
        match rollouts.loss(&x) {
            Ok((loss, by_x)) => {
                let (of_cost, _) = newton.derivatives(&y, gamma);
                let by_y = of_cost + newton.T.tr_mul(&DVector::from_vec(by_x));
                (cost + loss, S.tr_mul(&by_y).iter().copied().collect())
            }
            Err(error) => {
                failure.get_or_insert(error);
                (f64::INFINITY, vec![0.0; u.len()])
            }
        }
    };
    lbfgs::minimize(&mut u, options.iterations, 1e-7, f64::INFINITY, objective, stop);
    if let Some(error) = failure.filter(|_| u.iter().all(|u| *u == 0.0)) {
        return Err(error);
    }
    let y = &start + &S * DVector::from_vec(u);
    let x: Vec<f64> = (&newton.T * y).iter().copied().collect();
    let after = rollouts.errors(&x)?;
    Ok(Refinement { x, before, after })
}

struct Rollouts<'a, 'm> {
    found: &'a Identification<'m>,
    windows: Vec<Window<'a>>,
    window: f64,
    /// Sizes of errors of positions and velocities.
    sizes: Option<[Vec<f64>; 2]>,
}

/// Rollouts compared with the logs.
struct Compared {
    loss: f64,
    /// By the unknowns.
    gradient: Vec<f64>,
    /// Root mean squares of positions and velocities, by joint.
    errors: [Vec<f64>; 2],
}

/// The largest number of steps between two samples.
const MOST_STEPS: usize = 40;

impl Rollouts<'_, '_> {
    /// Steps between two samples, so that Runge-Kutta's method is stable: its largest rate is that of friction.
    fn steps(&self, robot: &Model, rate: f64) -> Result<usize, Error> {
        let width = self.found.setup.columns.choice.width;
        let (names, pi) = (robot.parameter_names(), robot.parameters());
        let M = robot.mass_matrix(&robot.neutral_configuration())?;
        let mut fastest = 0.0_f64;
        for (j, joint) in robot.joint_names().enumerate() {
            let value = |kind: &str| {
                names.iter().position(|name| name.strip_suffix(kind) == Some(joint)).map_or(0.0, |k| pi[k])
            };
            fastest = fastest.max((value(".damping") + value(".friction") / width) / M[(j, j)].max(1e-9));
        }
        // M's smallest eigenvalues are below its diagonal
        Ok(((3.0 * fastest / rate) as usize + 1).clamp(2, MOST_STEPS))
    }

    /// Runs all windows, and their adjoints.
    fn evaluate(&self, x: &[f64]) -> Result<Compared, Error> {
        let columns = &self.found.setup.columns;
        let n = columns.model.n();
        let pi = parameters(columns, x)?;
        let mut offset = vec![0.0; n];
        for (unknown, &value) in columns.unknowns.iter().zip(x) {
            if let Kind::Offset(j) = unknown.kind {
                offset[j] = value;
            }
        }
        let ones = [vec![1.0; n], vec![1.0; n]];
        let sizes = self.sizes.as_ref().unwrap_or(&ones);
        let (mut loss, mut by_pi, mut by_offset) = (0.0, vec![0.0; pi.len()], vec![0.0; n]);
        let mut squares = [vec![0.0; n], vec![0.0; n]];
        let mut count = 0.0;
        for Window { samples, first, tau: measured } in &self.windows {
            let robot = robot_of(columns.model, pi.clone(), samples)?;
            let length = (self.window * samples.rate).round() as usize;
            let steps = self.steps(&robot, samples.rate)?;
            let mut rollout = Rollout::new(&robot, 1.0 / (samples.rate * steps as f64), Method::RungeKutta4)?
                .with_friction(Friction::Smooth { slip_speed: columns.choice.width })?
                .with_parameter_gradient();
            let at = |table: &[f64], k: usize, j: usize| table[(first + k) * n + j];
            let mut tau = Vec::with_capacity(length * steps * n);
            for k in 0..length {
                for s in 0..steps {
                    let share = (s as f64 + 0.5) / steps as f64; // the middle of the step
                    tau.extend(
                        (0..n).map(|j| {
                            measured[k * n + j] * (1.0 - share) + measured[(k + 1) * n + j] * share - offset[j]
                        }),
                    );
                }
            }
            let row = first * n..(first + 1) * n;
            let weight = 1.0 / (2.0 * length as f64 * self.windows.len() as f64);
            let loss_of = |k: usize, theta: &[f64], dtheta: &[f64], by_theta: &mut [f64], by_dtheta: &mut [f64]| {
                if k == 0 || !k.is_multiple_of(steps) {
                    return;
                }
                for j in 0..n {
                    let errors =
                        [theta[j] - at(&samples.theta, k / steps, j), dtheta[j] - at(&samples.dtheta, k / steps, j)];
                    for (order, by) in [&mut *by_theta, &mut *by_dtheta].into_iter().enumerate() {
                        let e = errors[order] / sizes[order][j];
                        loss += weight * e * e;
                        by[j] += 2.0 * weight * e / sizes[order][j];
                        squares[order][j] += errors[order] * errors[order];
                    }
                }
            };
            let gradient = rollout.gradient(&samples.theta[row.clone()], &samples.dtheta[row], &tau, loss_of)?;
            by_pi.iter_mut().zip(&gradient.parameters).for_each(|(sum, g)| *sum += g);
            gradient.tau.iter().enumerate().for_each(|(k, g)| by_offset[k % n] -= g);
            count += length as f64;
        }
        let gradient = columns.unknowns.iter().map(|unknown| match unknown.kind {
            Kind::Link(k) | Kind::Armature(k) | Kind::Viscous(k) | Kind::Coulomb(k) | Kind::Stiffness(k) => by_pi[k],
            Kind::Offset(j) => by_offset[j],
            Kind::RotorViscous(_) | Kind::RotorCoulomb(_) => 0.0,
            Kind::Apparent(_) | Kind::Stribeck(_) | Kind::Payload(_) | Kind::Gain(_) => 0.0,
        });
        let rms = squares.map(|list| list.into_iter().map(|sum: f64| (sum / count).sqrt()).collect());
        Ok(Compared { loss, gradient: gradient.collect(), errors: rms })
    }

    fn loss(&self, x: &[f64]) -> Result<(f64, Vec<f64>), Error> {
        self.evaluate(x).map(|found| (found.loss, found.gradient))
    }

    fn errors(&self, x: &[f64]) -> Result<[Vec<f64>; 2], Error> {
        self.evaluate(x).map(|found| found.errors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Log, Options, identify};

    #[test]
    fn the_gradient_is_that_of_differences() {
        let model = mozzi_urdf::open("double_pendulum").expect("embedded").description.build().expect("sound");
        let wave = |k: usize, j: usize, order: i32| {
            let w = 2.0 + 1.7 * j as f64;
            w.powi(order) * (w * k as f64 * 0.01 + 1.57 * order as f64 + j as f64).sin()
        };
        let table = |order: i32| (0..400).flat_map(|k| (0..2).map(move |j| wave(k, j, order))).collect::<Vec<f64>>();
        let mut log = Log { name: "waves".into(), t: (0..400).map(|k| 0.01 * k as f64).collect(), ..Log::default() };
        (log.theta, log.dtheta, log.tau) = (table(0), Some(table(1)), table(2));
        let mut found = identify(&model, &[log], &Options::default(), &|| false).expect("an identification");
        let samples = &found.samples[0];
        let windows = [5, 60, 120].map(|first| Window::new(&model, samples, first, 10).expect("a window")).into();
        let sizes = Some([vec![0.1, 0.2], vec![1.0, 2.0]]);
        let rollouts = Rollouts { found: &found, windows, window: 0.1, sizes };
        let mut x = found.estimates.consistent.x.clone();
        let positive = found.setup.problem.of_robot().positive;
        positive.iter().for_each(|&k| x[k] = x[k].max(0.05));
        let (_, gradient) = rollouts.loss(&x).expect("rollouts");
        let scale = gradient.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        for k in 0..x.len() {
            let h = 1e-6;
            let at = |h: f64| {
                let mut x = x.clone();
                x[k] += h;
                rollouts.loss(&x).expect("rollouts").0
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            assert!((slope - gradient[k]).abs() < 1e-5 * scale, "{k}: {slope} and {}", gradient[k]);
        }
        // friction and armature that are exactly 0
        positive.iter().for_each(|&k| found.estimates.consistent.x[k] = 0.0);
        let options = RefineOptions { window: 0.1, windows: 2, iterations: 1 };
        refine(&found, &options, &|| false).expect("a refinement");
    }
}
