//! Figures of motions and of robots.

mod convergence;
mod ellipsoids;
mod motion;
mod robot;

pub use convergence::Convergence;
pub use ellipsoids::{Plane, ellipsoids};
pub use motion::{energy, phase, trajectories};
pub use robot::{Look, RobotPicture, View, robot};
