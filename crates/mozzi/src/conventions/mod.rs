//! Conversions of states, forces and matrices to and from the order, frames and signs of other libraries.
//!
//! Their velocities ν are linear in mozzi's, θ̇ = X(θ)ν, with X invertible. The rest follows: equal power gives forces
//! Xᵀτ, equal energy the mass matrix XᵀMX, and differentiation the accelerations, θ̈ = Xν̇ + Ẋν.

mod joint_order;
mod mujoco;
mod pinocchio;

pub use mujoco::MuJoCo;
pub use pinocchio::Pinocchio;

use joint_order::JointOrder;
