//! The quantities of rigid-body mechanics, one per file.

mod angular_velocity;
mod articulated_inertia;
mod axis_rate;
mod coriolis_factor;
mod inertia;
mod inertia_parameters;
mod joint_axis;
mod nearest_physical;
mod screw_axis;
pub mod solids;
mod wrenches;

pub use crate::lie::{Twist, Wrench};
pub(crate) use articulated_inertia::ArticulatedInertia;
pub(crate) use axis_rate::AxisRate;
pub(crate) use coriolis_factor::{CoriolisFactor, coriolis_moment};
pub use inertia::{InertiaVerdict, Rounded, SpatialInertia};
pub(crate) use joint_axis::JointAxis;
pub use screw_axis::{NotAScrew, ScrewAxis};
pub(crate) use wrenches::Wrenches;
