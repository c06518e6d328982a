//! Dynamics of open-chain robots in the screw notation of Lynch and Park.
#![cfg_attr(not(feature = "std"), no_std)]
extern crate alloc;
mod api;
pub mod dynamics;
pub mod kinematics;
pub mod lie;
pub mod linalg;
pub mod model;
#[cfg(feature = "std")]
pub mod native;
pub mod scalar;
pub mod spatial;
mod task_space;
#[cfg(test)]
mod testing;
pub use api::{BodyFrame, NewtonEuler};
pub use dynamics::*;
pub use kinematics::*;
pub use lie::{SE3, SO3};
pub use linalg::{Mat3, Sym3, Vec3};
pub use model::{Description, Environment, Error, Frame, FrameId, Model, Workspace};
pub use scalar::{Dual, Real, Scalar};
pub use spatial::{ScrewAxis, SpatialInertia, Twist, Wrench};
pub use task_space::{Task, TaskFrame, TaskSpaceDynamics};
