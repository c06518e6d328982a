//! Trajectories: joint motions in time (Modern Robotics, chapter 9).
//!
//! A [`Path`] gives the positions θ(s) for s from 0 to 1: a [`Line`] in the joints' space, a [`Spline`] through via
//! points, or the joints' path along a [`Cartesian`] one. A [`Profile`] gives the time scaling s(t): cubic, quintic,
//! trapezoidal, or as fast as limits allow ([`time_optimal`], [`stretched`]). Both together are [`Timed`], a
//! [`Reference`] that a controller can follow; so is a table, [`Recorded`].
//!
//! ```
//! use mozzi_motion::trajectories::{Limits, Line, Reference, Timed, time_optimal};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let line = Line::new(&model, &[0.0, -1.5, 1.5, 0.0, 0.0, 0.0], &[1.5, -1.0, 0.5, 0.0, 1.0, 0.0])?;
//! let limits = Limits { acceleration: vec![10.0; 6], ..Limits::of(&model) };
//! let motion = Timed::new(&line, time_optimal(&model, &line, &limits, 200)?);
//! let halfway = motion.at(0.5 * motion.duration());
//! assert!(halfway.dtheta.iter().zip(&limits.velocity).all(|(rate, limit)| rate.abs() <= limit * (1.0 + 1e-9)));
//! # Ok(()) }
//! ```

mod cartesian;
mod chart;
mod demands;
mod limits;
mod linear_program;
mod path;
mod profile;
mod recorded;
mod reference;
mod spline;
mod stretch;
mod time_optimal;

pub use cartesian::{Cartesian, Shape};
pub use limits::Limits;
pub use path::{Line, Path, Point};
pub use profile::{Profile, Progress};
pub use recorded::Recorded;
pub use reference::{Desired, Hold, OfJoints, Reference, Timed, times};
pub use spline::{Ends, Spline};
pub use stretch::stretched;
pub use time_optimal::time_optimal;

#[cfg(test)]
mod on_the_group;
#[cfg(test)]
mod tests;
