//! Secondary goals of a redundant robot.

use mozzi::Model;
use mozzi::model::difference;

/// The function to minimize among all positions that reach the goal.
#[derive(Default)]
pub enum Secondary<'a> {
    /// Nothing: the first solution.
    #[default]
    None,
    /// ½‖θ ⊖ θ_r‖²: the solution nearest to these positions.
    Near(&'a [f64]),
    /// H(θ), by a function that also writes its gradient, n numbers.
    Minimize(&'a dyn Fn(&[f64], &mut [f64]) -> f64),
}

impl Secondary<'_> {
    /// H and its gradient.
    pub(super) fn evaluate(&self, model: &Model, theta: &[f64], gradient: &mut [f64]) -> f64 {
        match self {
            Secondary::None => {
                gradient.fill(0.0);
                0.0
            }
            Secondary::Near(reference) => {
                difference(model, reference, theta, gradient);
                0.5 * gradient.iter().map(|x| x * x).sum::<f64>()
            }
            Secondary::Minimize(H) => H(theta, gradient),
        }
    }
}
