//! What surrounds the robots of a batch.

use mozzi::{Environment, FrameId};

/// What is the same for all states, and wrenches that differ from state to state.
#[derive(Clone, Copy, Debug)]
pub struct BatchEnvironment<'a, T = f64> {
    /// Gravity, the motion of {s}, and wrenches on the environment, for all states alike.
    pub environment: Environment<'a>,
    /// For each frame a table (N, 6): the wrench (m, f), in the frame's coordinates, that it applies to the environment in each state.
    pub wrenches: &'a [(FrameId, &'a [T])],
}

impl<'a, T> From<Environment<'a>> for BatchEnvironment<'a, T> {
    fn from(environment: Environment<'a>) -> Self {
        BatchEnvironment { environment, wrenches: &[] }
    }
}
