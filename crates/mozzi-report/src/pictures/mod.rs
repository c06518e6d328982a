//! Figures of motions and of robots.

mod convergence;
mod ellipsoids;
mod motion;

pub use convergence::{Convergence, convergence};
pub use ellipsoids::{Plane, ellipsoids};
pub use motion::{energy, phase, trajectories};
