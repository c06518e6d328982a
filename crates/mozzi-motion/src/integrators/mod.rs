//! Integrators beside [`mozzi::simulation`]'s three: an adaptive one, and one that keeps the energy for good; events; joints that stop at
//! their limits.
//!
//! | | order | step | for |
//! |---|---|---|---|
//! | [`Integrator::Fixed`] | 1, 1, 4 | given | [`mozzi::simulation::Method`]s, with events and limits |
//! | [`Integrator::DormandPrince`] | 5 | found | smooth motions, to a tolerance |
//! | [`Integrator::Midpoint`] | 2 | given | long motions: the energy's error is bounded |
//!
//! All of them integrate on SE(3) where the base floats. Events are zeros of functions of (t, θ, θ̇), found on the polynomial between two steps.
//! A joint's limit is ignored, reported, or respected: then the joint comes to rest there, inelastically, and is held as long as
//! it is pressed against its stop.
//!
//! ```
//! use mozzi_motion::Policy;
//! use mozzi_motion::integrators::{Event, Integrator, Simulation};
//! use mozzi::simulation::Zero;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = mozzi_urdf::open("double_pendulum")?.build()?;
//! let simulation = Simulation {
//!     integrator: Integrator::DormandPrince { tolerance: 1e-9 },
//!     events: vec![Event::new("the first rod hangs", |_, theta, _| theta[0])],
//!     ..Simulation::new(2.0)
//! };
//! let run = simulation.run(&model, &[1.0, 0.5], &[0.0, 0.0], Zero)?;
//! assert!(run.events[0].theta[0].abs() < 1e-12 && run.motion.largest_drift() < 1e-6);
//! # Ok(()) }
//! ```

mod convergence;
mod dense;
mod dormand_prince;
mod driven;
mod events;
mod midpoint;
mod run;
mod stops;

pub use convergence::{Convergence, Measured, convergence};
pub use events::{Direction, Event, EventFunction, Occurrence};
pub use run::{Run, Simulation};
pub use stops::Stopped;

use mozzi::simulation::{Method, Powers};

/// How time passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// One of [`mozzi::simulation`]'s methods, by steps of this many seconds.
    Fixed(Method, f64),
    /// Dormand and Prince's of order 5, by steps whose estimated error is below a tolerance: absolutely for θ (rad, m), for θ̇ relative to
    /// 1 + |θ̇|.
    DormandPrince {
        /// Above 0.
        tolerance: f64,
    },
    /// The implicit midpoint rule in (θ, p), by steps of this many seconds: symplectic; of a floating base it keeps the momentum, too.
    Midpoint {
        /// Seconds.
        step: f64,
    },
}

impl Integrator {
    /// "Dormand-Prince 5(4)", "implicit midpoint", or the method's.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::Fixed(method, _) => method.name(),
            Integrator::DormandPrince { .. } => "Dormand-Prince 5(4)",
            Integrator::Midpoint { .. } => "implicit midpoint",
        }
    }
}

/// A state with its rates.
#[derive(Clone, Debug, PartialEq)]
struct State {
    t: f64,
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    ddtheta: Vec<f64>,
    powers: Powers,
    /// ∫ of the powers.
    works: Powers,
}

/// A step from t, and where it ends: of its own length, or to `until`, where rounding leaves no crumb for a last one.
fn step_to(step: f64, t: f64, until: f64) -> (f64, f64) {
    if t + 1.001 * step >= until { (until - t, until) } else { (step, t + step) }
}

#[cfg(test)]
mod balls;
#[cfg(test)]
mod tests;
