//! Motions for the robots of [`mozzi`]: where the joints have to be ([`inverse_kinematics`]), and what they are to do when
//! ([`trajectories`]), motors that do it
//! ([`controllers`]), and what becomes of it ([`integrators`]).
//!
//! ```
//! use mozzi_motion::{Goal, InverseKinematics};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let tool = model.end_effector()?;
//! let goal = model.forward_kinematics(&[0.3, -1.2, 1.4, -0.5, 0.9, 2.0], tool)?;
//! let found = InverseKinematics::new(&model, tool)?.solve(Goal::Pose(goal), &[0.0; 6])?;
//! let reached = model.forward_kinematics(&found.theta, tool)?;
//! assert!((reached.inverse() * goal).log().norm() < 1e-8);
//! # Ok(()) }
//! ```

pub mod controllers;
mod error;
pub mod integrators;
pub mod inverse_kinematics;
mod policy;
pub mod trajectories;

pub use error::Error;
pub use inverse_kinematics::{Goal, InverseKinematics};
pub use policy::Policy;

/// The README's examples, run with the documentation's tests: here, where all of their crates are known.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
