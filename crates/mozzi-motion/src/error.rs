//! Errors of motions, with the numbers.

use crate::inverse_kinematics::Residual;
use mozzi::{Freedom, Model};

/// Why a motion could not be found.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An error of the robot's model.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
    /// A simulation of the robot.
    #[error(transparent)]
    Simulation(#[from] mozzi_sim::Error),
    /// Inverse kinematics ended before the goal.
    #[error(
        "frame `{frame}` did not reach its goal: the best of {starts} starts, {iterations} iterations in all, is {residual} away{}, at θ = {theta:?}",
        at_limits(limits)
    )]
    NotReached {
        /// The frame.
        frame: String,
        /// The best positions that were found.
        theta: Vec<f64>,
        /// The residual there.
        residual: Residual,
        /// The joints that are at a limit there.
        limits: Vec<String>,
        /// Starts, the given one included.
        starts: usize,
        /// Iterations of all starts.
        iterations: usize,
    },
    /// A frame cannot follow its path.
    #[error("at s = {s} of the path: {why}: {source}")]
    OffPath {
        /// Where on the path, 0 to 1.
        s: f64,
        /// The likely cause.
        why: String,
        /// Why not: [`Error::NotReached`].
        source: Box<Error>,
    },
    /// The joint solutions along a frame's path cannot be joined to one path.
    #[error(
        "the path of frame `{frame}` breaks at s = {s}: however close its solutions, the joints between them are {deviation:.1e} off it, more than \
         {tolerance:.1e} (a singular position, or a joint at its limit)"
    )]
    PathBroken {
        /// The frame.
        frame: String,
        /// Where on the path, 0 to 1.
        s: f64,
        /// ‖log(T⁻¹T_d)‖, rad and m.
        deviation: f64,
        /// The tolerance of the path.
        tolerance: f64,
    },
    /// A motor is too weak to move the robot along its path.
    #[error("the motor of `{joint}` is too weak at s = {s}: at rest it needs {needed} of its {limit} N m or N")]
    TooWeak {
        /// The joint.
        joint: String,
        /// Where on the path, 0 to 1.
        s: f64,
        /// |τ| at rest.
        needed: f64,
        /// Its limit.
        limit: f64,
    },
    /// No limit bounds the robot's speed.
    #[error("nothing limits the speed at s = {s} of the path: expected a limit of velocity, acceleration or torque")]
    Unlimited {
        /// Where on the path, 0 to 1.
        s: f64,
    },
}

fn at_limits(joints: &[String]) -> String {
    match joints {
        [] => String::new(),
        list => {
            format!(", with {} at a limit", list.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))
        }
    }
}

/// Returns an error for an invalid argument.
pub(crate) fn check(
    fine: bool,
    what: &'static str,
    found: impl std::fmt::Display,
    expected: &'static str,
) -> Result<(), Error> {
    if fine { Ok(()) } else { Err(mozzi::Error::BadArgument { what, found: found.to_string(), expected }.into()) }
}

/// Checks that the robot has no constraints.
pub(crate) fn check_open(model: &Model, what: &'static str) -> Result<(), Error> {
    let m = model.constraint_rows();
    check(m == 0, what, format!("with {m} constraint rows"), "a robot without constraints")
}

/// Checks that every velocity has a motor. A floating base and a free joint have none.
pub(crate) fn check_driven(model: &Model, what: &'static str) -> Result<(), Error> {
    check(!model.is_floating(), what, "on a free base", "a fixed base: no motor moves a free one")?;
    let free = model.joints().zip(model.places()).find(|(_, place)| place.freedom == Freedom::Free);
    let found = free.map(|(joint, _)| format!("with `{}`, a free joint", joint.name));
    check(found.is_none(), what, found.unwrap_or_default(), "joints that motors move")
}
