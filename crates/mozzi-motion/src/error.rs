//! What can go wrong with a motion, with the numbers.

use crate::inverse_kinematics::Residual;

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
