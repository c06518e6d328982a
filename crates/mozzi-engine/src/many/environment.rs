//! The environment of a batch.

use mozzi::{Environment, FrameId};

/// The environment common to all states, and wrenches, gravity and inertial parameters that differ between states.
#[derive(Clone, Copy, Debug)]
pub struct BatchEnvironment<'a, T = f64> {
    /// Gravity, the motion of {s}, and applied wrenches, equal for all states.
    pub environment: Environment<'a>,
    /// For each frame a table (N, 6): the wrench (m, f), in the frame's coordinates, that it applies to the environment
    /// in each state.
    pub wrenches: &'a [(FrameId, &'a [T])],
    /// A table (N, 3): gravity in {s} in each state, instead of the environment's.
    pub gravity: Option<&'a [T]>,
    /// A table (N, p): the inertial parameters of each state's robot, instead of the model's
    /// [`parameters`](mozzi::Model::parameters).
    pub parameters: Option<&'a [T]>,
}

impl<'a, T> From<Environment<'a>> for BatchEnvironment<'a, T> {
    fn from(environment: Environment<'a>) -> Self {
        BatchEnvironment { environment, wrenches: &[], gravity: None, parameters: None }
    }
}

impl<'a, T> BatchEnvironment<'a, T> {
    /// With these wrenches in each state.
    pub fn with_wrenches(self, wrenches: &'a [(FrameId, &'a [T])]) -> Self {
        BatchEnvironment { wrenches, ..self }
    }
}
