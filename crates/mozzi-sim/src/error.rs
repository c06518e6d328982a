//! Errors of simulations, with the numbers that caused them.

use alloc::format;
use alloc::string::String;
use core::fmt;

/// Errors of simulations.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Error {
    /// An error of the robot or of an argument.
    Model(mozzi::Error),
    /// The start violates a constraint.
    OpenStart {
        /// The constraint.
        constraint: String,
        /// Its violation, rad or m, or their rates.
        residual: f64,
        /// Position or velocity.
        what: &'static str,
    },
    /// A constraint cannot be kept.
    Opened {
        /// The constraint that is violated most.
        constraint: String,
        /// Its violation.
        residual: f64,
        /// When, s.
        time: f64,
    },
    /// Loops close only with other velocities.
    Jumped {
        /// The velocity that changes most.
        joint: String,
        /// By this much, rad/s or m/s.
        change: f64,
        /// When, s.
        time: f64,
    },
    /// The energy of a robot with loops is off by more than a hundredth of the largest kinetic energy.
    Drifted {
        /// Its constraints.
        loops: String,
        /// J
        drift: f64,
        /// The largest so far, J.
        kinetic: f64,
        /// When, s.
        time: f64,
        /// The steps, and those that may do, s.
        steps: [f64; 2],
    },
    /// The state became infinite, NaN or too large.
    Diverged {
        /// "theta", "dtheta" or "ddtheta".
        quantity: &'static str,
        /// The joint.
        joint: String,
        /// Infinite, NaN, or so large (10¹⁵⁰) that energies overflow.
        value: f64,
        /// Steps are counted from 1; 0 is the start.
        step: usize,
        /// Seconds.
        time: f64,
        /// Seconds.
        step_size: f64,
    },
    /// The steps are so short that the simulation would practically never end.
    Stalled {
        /// Seconds.
        time: f64,
        /// The joint whose motion requires the shortest steps.
        joint: String,
        /// The steps, their reason, and a remedy.
        cause: String,
    },
    /// A joint reaches a limit that is respected, by a method of smooth motion, which has no stops.
    StopActs {
        /// The joint.
        joint: String,
        /// rad or m.
        limit: f64,
        /// Seconds.
        time: f64,
        /// The method.
        method: &'static str,
    },
    /// The iteration of an implicit step does not converge.
    NoConvergence {
        /// The joint whose velocity changes most between iterations.
        joint: String,
        /// Seconds.
        time: f64,
        /// Seconds.
        step: f64,
        /// Iterations.
        iterations: usize,
    },
    /// An invalid event condition.
    Condition {
        /// The condition.
        text: String,
        /// The problem, and the expected form.
        problem: String,
    },
}

impl From<mozzi::Error> for Error {
    fn from(error: mozzi::Error) -> Self {
        Error::Model(error)
    }
}

/// A number with six digits.
fn short(x: f64) -> String {
    let x: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if x == 0.0 || (1e-4..1e6).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Model(error) => error.fmt(f),
            Error::OpenStart { constraint, residual, what } => write!(
                f,
                "the start has {what} that violates constraint `{constraint}` by {residual:.3e}, expected at most 1e-6; `assemble` \
                 closes positions, `assemble_velocities` or `constraint_impulse` velocities"
            ),
            Error::Opened { constraint, residual, time } => write!(
                f,
                "constraint `{constraint}` cannot be closed at t = {time} s: {residual:.3e} rad or m are left; the step may be too \
                 long, or the mechanism at the end of its reach"
            ),
            Error::Jumped { joint, change, time } => write!(
                f,
                "the loops close at t = {time} s only if the velocity of `{joint}` jumps by {change:.3e}: the mechanism passes a \
                 change point, where it could go on in two ways, or the step is too long: a shorter one may do"
            ),
            Error::Drifted { loops, drift, kinetic, time, steps } => {
                let [drift, kinetic, time] = [*drift, *kinetic, *time].map(short);
                write!(
                    f,
                    "the energy is off by {drift} J until t = {time} s, and the largest kinetic energy is {kinetic} J: the loops {loops} \
                     need shorter steps than {} s; try {} s, unless they pass a change point, where no step is short enough",
                    steps[0], steps[1]
                )
            }
            Error::Diverged { quantity, joint, value, step, time, step_size } => {
                write!(f, "the simulation diverged: {quantity} of ")?;
                match joint.as_str() {
                    "" => write!(f, "the base")?,
                    joint => write!(f, "joint `{joint}`")?,
                }
                let [value, time, step_size] = [*value, *time, *step_size].map(short);
                write!(
                    f,
                    " is {value} in step {step}, at t = {time} s, with steps of {step_size} s; a smaller step may help"
                )
            }
            Error::Stalled { time, joint, cause } => {
                write!(f, "the simulation does not advance at t = {time} s, because of joint `{joint}`: {cause}")
            }
            Error::StopActs { joint, limit, time, method } => write!(
                f,
                "joint `{joint}` reaches its limit {limit} at t = {time} s, and {method} has no stops: `moreau` or `auto` has"
            ),
            Error::NoConvergence { joint, time, step, iterations } => write!(
                f,
                "the implicit step of {step} s at t = {time} s did not converge in {iterations} iterations at joint `{joint}`, which is \
                 stiff, or jumps; a smaller step or smooth friction may help"
            ),
            Error::Condition { text, problem } => write!(f, "`{text}`{problem}"),
        }
    }
}

impl core::error::Error for Error {}
