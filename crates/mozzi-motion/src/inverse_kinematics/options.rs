//! How inverse kinematics searches.

use super::Method;
use crate::Error;
use crate::error::check;

/// How a solution is searched for. Start from [`default`](Self::default) and change what differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How a step is damped; Levenberg-Marquardt.
    pub method: Method,
    /// The largest angle to the goal that is called reached, rad; 10⁻⁸.
    pub angle: f64,
    /// The largest distance, m; 10⁻⁸.
    pub distance: f64,
    /// Iterations of one start; 60.
    pub iterations: usize,
    /// Starts, the first from the guess, the others from random positions; 200.
    pub starts: usize,
    /// Of the random starts: the same seed finds the same solution.
    pub seed: u64,
    /// What counts as much as a radian, m; 1.
    pub length: f64,
    /// Keep the joints within their limits? Yes, unless told otherwise.
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
