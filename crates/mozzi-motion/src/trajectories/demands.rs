//! The torques that a path requires: τ = a s̈ + b ṡ² + c + d ṡ, linear in s̈ and ṡ² except for viscous friction.

use super::path::Path;
use crate::Error;
use crate::error::check;
use mozzi::dynamics::{inverse_dynamics, spring_forces};
use mozzi::{Environment, Model, Workspace};

/// The coefficients of each of the n velocities at one s.
#[derive(Clone, Debug)]
pub(super) struct Demand {
    pub s: f64,
    /// θ′.
    pub slope: Vec<f64>,
    /// θ″.
    pub curvature: Vec<f64>,
    /// Mθ′.
    pub a: Vec<f64>,
    /// Mθ″ + c(θ, θ′).
    pub b: Vec<f64>,
    /// g + k(θ − θ₀) + μ sgn θ′.
    pub c: Vec<f64>,
    /// g + k(θ − θ₀): the torques at rest.
    pub g: Vec<f64>,
    /// The viscous friction of θ′.
    pub d: Vec<f64>,
}

/// As [`demands`], with an error if nothing moves along the path.
pub(super) fn demands_of_a_motion(model: &Model, path: &impl Path, s: &[f64]) -> Result<Vec<Demand>, Error> {
    let all = demands(model, path, s);
    let moves = all.iter().any(|demand| demand.slope.iter().any(|&x| x != 0.0));
    check(moves, "the way of every joint along the path", 0, "a path along which something moves")?;
    Ok(all)
}

/// The demands at these s, by three inverse dynamics each.
pub(super) fn demands(model: &Model, path: &impl Path, s: &[f64]) -> Vec<Demand> {
    let (n, mut workspace) = (model.n(), Workspace::new(model));
    let still = vec![0.0; n];
    let weightless = Environment::with_gravity(mozzi::Vec3::zero());
    let damping: Vec<f64> = damping(model);
    let mut at = |s: f64| {
        let point = path.at(s);
        let mut tau = |environment: &Environment, dtheta: &[f64], ddtheta: &[f64]| {
            let mut tau = vec![0.0; n];
            inverse_dynamics(model, &point.theta, dtheta, ddtheta, environment, &mut workspace, &mut tau);
            tau
        };
        let g = tau(&model.environment(), &still, &still);
        let mut c = g.clone();
        let mut a = tau(&weightless, &still, &point.slope);
        let mut b = tau(&weightless, &point.slope, &point.curvature);
        let d: Vec<f64> = damping.iter().zip(&point.slope).map(|(d, x)| d * x).collect();
        let mut springs = vec![0.0; n];
        spring_forces(model, &point.theta, &mut springs);
        for j in 0..n {
            a[j] -= springs[j];
            b[j] -= springs[j];
            let f = mozzi::dynamics::joint_friction(model, j, point.slope[j]); // at ṡ = 1
            b[j] -= f;
            c[j] += f - d[j];
        }
        Demand { s, slope: point.slope, curvature: point.curvature, a, b, c, g, d }
    };
    s.iter().map(|&s| at(s)).collect()
}

/// d of each velocity: the increase of friction from 1 to 2 rad/s.
fn damping(model: &Model) -> Vec<f64> {
    (0..model.n())
        .map(|j| mozzi::dynamics::joint_friction(model, j, 2.0) - mozzi::dynamics::joint_friction(model, j, 1.0))
        .collect()
}
