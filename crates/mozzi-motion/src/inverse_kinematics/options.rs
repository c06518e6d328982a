//! How inverse kinematics searches.

use super::Method;
use crate::Error;
use crate::error::check;

/// Options of the search. Start from [`default`](Self::default) and change what differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How a step is damped; default Levenberg-Marquardt.
    pub method: Method,
    /// Tolerance of the angle to the goal, rad; default 10⁻⁸.
    pub angle: f64,
    /// Tolerance of the distance to the goal, m; default 10⁻⁸.
    pub distance: f64,
    /// Maximum iterations of one start; default 60.
    pub iterations: usize,
    /// Maximum number of starts, the first from the guess, the others from random positions; default 200.
    pub starts: usize,
    /// Seed of the random starts: the same seed finds the same solution.
    pub seed: u64,
    /// The length that counts as much as a radian, m; default 1.
    pub length: f64,
    /// True to keep the joints within their limits. Default true.
    pub limits: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            method: Method::LevenbergMarquardt,
            angle: 1e-8,
            distance: 1e-8,
            iterations: 60,
            starts: 200,
            seed: 0,
            length: 1.0,
            limits: true,
        }
    }
}

impl Options {
    pub(super) fn check(&self) -> Result<(), Error> {
        for (what, x) in [
            ("the tolerance of the angle", self.angle),
            ("the tolerance of the distance", self.distance),
            ("length", self.length),
        ] {
            check(x > 0.0 && x.is_finite(), what, x, "a positive, finite number")?;
        }
        check(self.iterations > 0, "iterations", self.iterations, "at least 1")?;
        check(self.starts > 0, "starts", self.starts, "at least 1")
    }
}
