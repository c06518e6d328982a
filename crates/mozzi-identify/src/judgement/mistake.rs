//! Mistakes that may have been made in a log, each undone in a sample.

use crate::mend::is_revolute;
use crate::signals::Samples;
use core::f64::consts::{FRAC_PI_2, PI};
use mozzi::{FrameId, Model, Vec3, Wrench};

/// One joint's positions are not taken for degrees below this, rad.
const TURN: f64 = 2.0 * PI;

/// A mistake that may have been made.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    None,
    SwappedForces(usize, usize),
    SwappedMotions(usize, usize),
    SwappedJoints(usize, usize),
    /// The joints in the reverse order.
    Reversed,
    ForceSign(usize),
    MotionSign(usize),
    JointSign(usize),
    AllForceSigns,
    /// The force of a joint is this many times too large.
    ForceScale(usize, f64),
    Degrees,
    JointDegrees(usize),
    /// The positions of a revolute joint lack this, rad.
    Offset(usize, f64),
    /// Forces are shares of the effort limits, this many to one.
    Rated(f64),
    Gravity([f64; 3]),
    /// Forces without those of gravity.
    NoGravity,
    /// Measured wrenches that do not act on the robot.
    Wrench,
    /// Measured wrenches of the opposite sign.
    WrenchSign,
}

impl Mistake {
    /// Every mistake that is tried, for positions up to `most`.
    pub fn all(model: &Model, has_limits: bool, most: &[f64]) -> Vec<Mistake> {
        let n = model.n();
        let mut all = Vec::new();
        let quarters = [FRAC_PI_2, -FRAC_PI_2, PI];
        for (a, name) in model.velocity_names().enumerate() {
            all.extend([Mistake::ForceSign(a), Mistake::MotionSign(a), Mistake::JointSign(a)]);
            if is_revolute(model, name) {
                all.extend(quarters.map(|offset| Mistake::Offset(a, offset)));
            }
            if most[a] > TURN {
                all.push(Mistake::JointDegrees(a));
            }
        }
        all.extend(Mistake::swaps(n));
        all.extend([Mistake::Degrees, Mistake::AllForceSigns]);
        if n > 2 {
            all.push(Mistake::Reversed);
        }
        if has_limits {
            all.extend([100.0, 1000.0].map(Mistake::Rated));
        }
        let g = model.gravity().0;
        let size = Vec3(g).norm();
        if size > 0.0 {
            let directions = (0..3).flat_map(|axis| {
                [1.0, -1.0].map(|sign| core::array::from_fn(|i| if i == axis { sign * size } else { 0.0 }))
            });
            let others = directions.filter(|d: &[f64; 3]| Vec3(*d).dot(Vec3(g)) < 0.99 * size * size);
            all.extend(others.map(Mistake::Gravity));
            all.push(Mistake::NoGravity);
        }
        all
    }

    /// Those of the samples' measured wrenches.
    pub fn of_wrenches(samples: &Samples) -> impl Iterator<Item = Mistake> {
        [Mistake::Wrench, Mistake::WrenchSign].into_iter().filter(|_| !samples.wrenches.is_empty())
    }

    /// The wrenches of sample k without the mistake.
    pub fn applied(&self, samples: &Samples, k: usize) -> Vec<(FrameId, Wrench)> {
        let applied = samples.applied(k).into_iter();
        match self {
            Mistake::Wrench => Vec::new(),
            Mistake::WrenchSign => applied.map(|(frame, F)| (frame, -F)).collect(),
            _ => applied.collect(),
        }
    }

    /// Joints of each pair.
    pub fn swaps(n: usize) -> impl Iterator<Item = Mistake> {
        let pairs = (0..n).flat_map(move |a| (a + 1..n).map(move |b| (a, b)));
        pairs.flat_map(|(a, b)| {
            [Mistake::SwappedForces(a, b), Mistake::SwappedMotions(a, b), Mistake::SwappedJoints(a, b)]
        })
    }

    /// Undoes the mistake in odd functions of the velocities.
    pub fn undo_rates(&self, rates: &mut [f64]) {
        match *self {
            Mistake::SwappedMotions(a, b) | Mistake::SwappedJoints(a, b) => rates.swap(a, b),
            Mistake::MotionSign(a) | Mistake::JointSign(a) => rates[a] = -rates[a],
            _ => {}
        }
    }

    /// Undoes the mistake in one sample: positions, velocities and accelerations, and forces.
    pub fn undo(&self, motion: &mut [Vec<f64>; 3], tau: &mut [f64], limits: &[f64]) {
        match *self {
            Mistake::None | Mistake::Gravity(_) | Mistake::NoGravity | Mistake::Wrench | Mistake::WrenchSign => {}
            Mistake::SwappedForces(a, b) => tau.swap(a, b),
            Mistake::SwappedMotions(a, b) => motion.iter_mut().for_each(|x| x.swap(a, b)),
            Mistake::SwappedJoints(a, b) => {
                motion.iter_mut().for_each(|x| x.swap(a, b));
                tau.swap(a, b);
            }
            Mistake::Reversed => {
                motion.iter_mut().for_each(|x| x.reverse());
                tau.reverse();
            }
            Mistake::ForceSign(a) => tau[a] = -tau[a],
            Mistake::MotionSign(a) => motion.iter_mut().for_each(|x| x[a] = -x[a]),
            Mistake::JointSign(a) => {
                motion.iter_mut().for_each(|x| x[a] = -x[a]);
                tau[a] = -tau[a];
            }
            Mistake::ForceScale(a, factor) => tau[a] /= factor,
            Mistake::AllForceSigns => tau.iter_mut().for_each(|x| *x = -*x),
            Mistake::Degrees => motion.iter_mut().flatten().for_each(|x| *x = x.to_radians()),
            Mistake::JointDegrees(a) => motion.iter_mut().for_each(|x| x[a] = x[a].to_radians()),
            Mistake::Offset(a, offset) => motion[0][a] += offset,
            Mistake::Rated(whole) => tau.iter_mut().zip(limits).for_each(|(x, limit)| *x *= limit / whole),
        }
    }

    /// The finding's code.
    pub fn code(&self) -> &'static str {
        match self {
            Mistake::None => "",
            Mistake::SwappedForces(..) | Mistake::SwappedMotions(..) | Mistake::SwappedJoints(..) => "swapped_joints",
            Mistake::Reversed => "swapped_joints",
            Mistake::ForceSign(_) | Mistake::MotionSign(_) | Mistake::JointSign(_) | Mistake::AllForceSigns => "sign",
            Mistake::Degrees | Mistake::JointDegrees(_) | Mistake::ForceScale(..) | Mistake::Rated(_) => "unit",
            Mistake::Offset(..) => "offset",
            Mistake::Gravity(_) | Mistake::NoGravity => "gravity",
            Mistake::Wrench | Mistake::WrenchSign => "wrench",
        }
    }

    /// The mistake in words, with the remedy if it is not obvious.
    pub fn text(&self, model: &Model) -> String {
        let names: Vec<&str> = model.velocity_names().collect();
        match *self {
            Mistake::None => String::new(),
            Mistake::SwappedForces(a, b) => format!("the forces of {} and {} seem to be swapped", names[a], names[b]),
            Mistake::SwappedMotions(a, b) => {
                format!("the positions of {} and {} seem to be swapped", names[a], names[b])
            }
            Mistake::SwappedJoints(a, b) => format!("the columns of {} and {} seem to be swapped", names[a], names[b]),
            Mistake::Reversed => format!(
                "the joints seem to be in the reverse order, from {} to {}",
                names.last().copied().unwrap_or_default(),
                names.first().copied().unwrap_or_default()
            ),
            Mistake::ForceSign(a) => format!("the force of {} seems to have the opposite sign", names[a]),
            Mistake::MotionSign(a) => {
                format!("position and velocity of {} seem to have the opposite sign", names[a])
            }
            Mistake::JointSign(a) => format!("all columns of {} seem to have the opposite sign", names[a]),
            Mistake::ForceScale(a, factor) => {
                format!("the force of {} seems to be in another unit, {factor} times as large as in N m", names[a])
            }
            Mistake::AllForceSigns => "all forces seem to have the opposite sign".to_string(),
            Mistake::Degrees => {
                "positions and velocities seem to be in degrees, expected rad; name them q1_deg, qd1_deg/s".to_string()
            }
            Mistake::JointDegrees(a) => format!(
                "position and velocity of {} seem to be in degrees, expected rad; name its columns q_deg, qd_deg/s",
                names[a]
            ),
            Mistake::Offset(a, offset) => format!(
                "the zero of {} seems to be another than the file's: its positions fit if {offset:.3} ({:.1}°) is added",
                names[a],
                offset.to_degrees()
            ),
            Mistake::Rated(whole) => format!(
                "forces are not in N m: they seem to be in {} of the rated torque, the file's effort limit; multiply \
                 each by limit/{whole}, or log N m",
                if whole < 500.0 { "per cent" } else { "per mille" }
            ),
            Mistake::Gravity(g) => {
                let shown = |g: [f64; 3]| g.map(|x| format!("{:.3}", x + 0.0)).join(", ");
                let (found, own) = (shown(g), shown(model.gravity().0));
                format!("gravity seems to be ({found}) m/s² in the base frame, not ({own}): give it with the robot")
            }
            Mistake::Wrench => {
                "the measured wrenches seem not to act on the robot: a sensor with an offset, in another \
                                frame, or behind the load; remove their columns"
                    .to_string()
            }
            Mistake::WrenchSign => {
                "the measured wrenches seem to have the opposite sign: what acts on the robot, expected what \
                                    the robot applies to its environment"
                    .to_string()
            }
            Mistake::NoGravity => {
                "forces seem to lack those of gravity, as those of drivers that compensate it; log the \
                                   motors' own torques, or add g(θ) of the robot's file"
                    .to_string()
            }
        }
    }
}
