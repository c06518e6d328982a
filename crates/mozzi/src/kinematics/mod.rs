//! Poses, velocities and Jacobians of frames.

mod base;
mod exponentials;
pub(crate) mod forward;
pub(crate) mod frame_acceleration;
pub(crate) mod jacobian;
pub(crate) mod jacobian_derivative;
pub(crate) mod jacobian_rate;
mod joint_transforms;
mod link_twists;

#[cfg(test)]
mod tests;

pub(crate) use base::{base_motion, base_pose, base_twist};
pub use jacobian::twist_of;
pub(crate) use joint_transforms::{joint_sines, joint_transforms};
pub(crate) use link_twists::link_twists;

pub use exponentials::{
    body_jacobian_of_screws, body_product_of_exponentials, product_of_exponentials, space_jacobian_of_screws,
};
pub use forward::{forward_kinematics, frame_poses};
pub use frame_acceleration::frame_acceleration;
pub use jacobian::{Jacobian, body_jacobian, space_jacobian};
pub use jacobian_derivative::{body_jacobian_derivative, space_jacobian_derivative};
pub use jacobian_rate::{body_jacobian_rate, space_jacobian_rate};
