//! The nouns of rigid-body mechanics: one noun, one file.

mod articulated_inertia;
mod body_coriolis;
mod inertia;
mod inertia_parameters;
mod joint_axis;
mod nearest_physical;
mod screw_axis;
pub mod solids;
mod spin;
mod twist;
mod wrench;

pub use articulated_inertia::ArticulatedInertia;
pub(crate) use body_coriolis::CoriolisFactor;
pub use inertia::{InertiaVerdict, Rounded, SpatialInertia};
pub(crate) use joint_axis::JointAxis;
pub use screw_axis::{NotAScrew, ScrewAxis};
pub use twist::Twist;
pub use wrench::Wrench;
