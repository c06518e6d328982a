//! Motions for the robots of [`mozzi`]: joint positions that reach a goal ([`inverse_kinematics`]), motions in time
//! ([`trajectories`]), and motors that follow them ([`controllers`]). [`mozzi_sim`] simulates the resulting
//! motion; [`convergence`] measures the accuracy of its methods.
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
pub mod convergence;
mod error;
pub mod inverse_kinematics;
pub mod trajectories;

pub use error::Error;
pub use inverse_kinematics::{Goal, InverseKinematics};
pub use mozzi_sim::Policy;
