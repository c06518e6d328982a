//! What can go wrong with a motion, with the numbers.

use crate::inverse_kinematics::Residual;
use mozzi::{Freedom, Model};

/// Why a motion could not be found.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The robot cannot be asked this.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
    /// Inverse kinematics ended before the goal.
    #[error(
        "frame `{frame}` did not reach its goal: the best of {starts} starts, {iterations} iterations in all, is {residual} away{}, at θ = {theta:?}",
        at_limits(limits)
    )]
    NotReached {
        /// The frame that was to be there.
        frame: String,
        /// The best positions that were found.
        theta: Vec<f64>,
        /// What is left there.
        residual: Residual,
        /// The joints that are at a limit there.
        limits: Vec<String>,
        /// Starts, the given one included.
        starts: usize,
        /// Of all starts.
        iterations: usize,
    },
    /// A frame cannot be led along its path.
    #[error("at s = {s} of the path: {source}")]
    OffPath {
        /// Where on the path, 0 to 1.
        s: f64,
        /// Why not: [`Error::NotReached`].
        source: Box<Error>,
    },
    /// The joints' path along a frame's cannot be joined.
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
    /// A motor cannot carry the robot along its path.
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
    /// Nothing keeps the robot from being infinitely fast.
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

/// An argument that is not what it should be.
pub(crate) fn check(
    fine: bool,
    what: &'static str,
    found: impl std::fmt::Display,
    expected: &'static str,
) -> Result<(), Error> {
    if fine { Ok(()) } else { Err(mozzi::Error::BadArgument { what, found: found.to_string(), expected }.into()) }
}

/// Has the robot no constraints?
pub(crate) fn check_open(model: &Model, what: &'static str) -> Result<(), Error> {
    let m = model.constraint_rows();
    check(m == 0, what, format!("with {m} constraint rows"), "a robot without constraints")
}

/// Has every velocity a motor? A floating base and a free joint have none.
pub(crate) fn check_driven(model: &Model, what: &'static str) -> Result<(), Error> {
    check(!model.is_floating(), what, "on a free base", "a fixed base: no motor moves a free one")?;
    let free = model.joints().zip(model.places()).find(|(_, place)| place.freedom == Freedom::Free);
    let found = free.map(|(joint, _)| format!("with `{}`, a free joint", joint.name));
    check(found.is_none(), what, found.unwrap_or_default(), "joints that motors move")
}
