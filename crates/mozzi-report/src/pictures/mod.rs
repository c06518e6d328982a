//! Figures of motions and of robots.

mod convergence;
mod ellipsoids;
mod motion;

pub use convergence::Convergence;
pub use ellipsoids::{Plane, ellipsoids};
pub use motion::{energy, phase, trajectories};
