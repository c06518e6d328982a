//! Mistakes in a log that the robot's own values reveal: joints mixed up, signs, units, the direction of gravity.

use super::gains::{self, Fit, Gain};
use crate::signals::Samples;
use crate::{Error, Finding};
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Environment, Freedom, Model, Vec3, fast};

/// The logarithms of the joints' squared errors must fall by this much in all before a mistake is reported.
const CLEAR: f64 = 1.5;

/// By this much before it is a fault.
const SURE: f64 = 2.5;

/// The largest share of the variance, %, that is unexplained once the mistake is undone, of a fault.
const EXPLAINED: f64 = 20.0;

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
    Degrees,
    Gravity([f64; 3]),
    AllForceSigns,
}

/// Compares the log with the robot's own prediction under each possible mistake, and reports the one that explains it
/// far better than none, if nearly all of the forces are explained then: two mistakes at once are not one. Only
/// joints of one axis are compared.
///
/// # Errors
/// [`Error::Model`].
pub fn mistakes(model: &Model, log: &str, samples: &Samples) -> Result<Vec<Finding>, Error> {
    let places = model.configuration_space().places();
    if places.iter().any(|place| place.freedom != Freedom::One) || samples.count() < 20 {
        return Ok(Vec::new());
    }
    let n = model.n();
    let names: Vec<&str> = model.velocity_names().collect();
    let mut comparison = Comparison::new(model, samples);
    let as_it_is = comparison.score(&Mistake::None);
    let (mut best, mut least) = (Mistake::None, as_it_is);
    for mistake in candidates(model) {
        let score = comparison.score(&mistake);
        if score < least {
            (best, least) = (mistake, score);
        }
    }
    let share = |score: f64| 100.0 * (score / n as f64).exp();
    let gains = comparison.gains();
    let scaled: f64 = gains.iter().map(|gain| gain.unexplained.ln()).sum();
    // a factor for each force explains more than any single mistake: the unit
    let is_scale = gains::is_scale(&gains) && as_it_is - scaled > CLEAR && scaled < least.min(as_it_is - CLEAR) + 0.5;
    let evidence = |score: f64| {
        format!(
            "then the robot's own values leave {:.2} % of each force's variance unexplained, now {:.2} % (geometric means)",
            share(score),
            share(as_it_is)
        )
    };
    if is_scale {
        return Ok(vec![Finding::fault(
            "unit",
            format!("{log}: {}; {}", gains::text(&gains, &names), evidence(scaled)),
        )]);
    }
    if !(as_it_is - least > CLEAR) {
        return Ok(Vec::new());
    }
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
        Mistake::AllForceSigns => ("sign", "all forces seem to have the opposite sign".to_string()),
        Mistake::Degrees => (
            "unit",
            "positions and velocities seem to be in degrees, expected rad; name them q1_deg, qd1_deg/s".to_string(),
        ),
        Mistake::Gravity(g) => {
            ("gravity", format!("gravity seems to be {g:?} m/s² in the base frame, not {:?}", model.gravity().0))
        }
    };
    let text = format!("{log}: {text}; {}", evidence(least));
    let is_sure = as_it_is - least > SURE && share(least) < EXPLAINED;
    // what explains little is no explanation
    Ok(match is_sure {
        true => vec![Finding::fault(code, text)],
        false if share(least) < 2.0 * EXPLAINED => vec![Finding::warning(code, text)],
        false => vec![Finding::warning(
            "contradiction",
            format!(
                "{log}: the robot's own values leave {:.0} % of each force's variance unexplained, and no single mistake \
                 explains it: columns, signs or units of several joints, or the robot's file",
                share(as_it_is)
            ),
        )],
    })
}

/// Every mistake that is tried.
fn candidates(model: &Model) -> Vec<Mistake> {
    let n = model.n();
    let mut all = Vec::new();
    for a in 0..n {
        all.extend([Mistake::ForceSign(a), Mistake::MotionSign(a), Mistake::JointSign(a)]);
        for b in a + 1..n {
            all.extend([Mistake::SwappedForces(a, b), Mistake::SwappedMotions(a, b), Mistake::SwappedJoints(a, b)]);
        }
    }
    all.extend([Mistake::Degrees, Mistake::AllForceSigns]);
    let g = model.gravity().0;
    let size = Vec3(g).norm();
    if size > 0.0 {
        let directions = (0..3).flat_map(|axis| {
            [1.0, -1.0].map(|sign| core::array::from_fn(|i| if i == axis { sign * size } else { 0.0 }))
        });
        all.extend(directions.filter(|d: &[f64; 3]| Vec3(*d).dot(Vec3(g)) < 0.99 * size * size).map(Mistake::Gravity));
    }
    all
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
        self.sums(mistake).iter().map(|fit| fit.unexplained().max(1e-12).ln()).sum()
    }

    /// The factor of each force that fits best.
    fn gains(&mut self) -> Vec<Gain> {
        self.sums(&Mistake::None).iter().map(Fit::gain).collect()
    }

    fn sums(&mut self, mistake: &Mistake) -> Vec<Fit> {
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
        sums
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
        Mistake::AllForceSigns => tau.iter_mut().for_each(|x| *x = -*x),
        Mistake::Degrees => motion.iter_mut().flatten().for_each(|x| *x = x.to_radians()),
    }
}
