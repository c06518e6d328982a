//! Robots with constraints: loops that close, pinned feet, coupled joints, wheels that roll (Modern Robotics, section
//! 8.7).
//!
//! > A(θ)θ̇ = 0,  τ = M(θ)θ̈ + h(θ, θ̇) + Aᵀ(θ)λ
//!
//! λ are the forces and moments that the robot applies through its constraints: between anchors {a} and {b} the wrench
//! that {b} applies to {a}, in the axes of {a}, about the origin of {b}.
//!
//! Constraints belong to the robot: see [`Constraint`](crate::model::description::Constraint) and
//! [`Model::with_constraints`](crate::Model::with_constraints). They may be redundant: λ is then the one of least norm
//! in the limit, and Aᵀλ and θ̈ are unique.

pub mod delassus;
mod forward_dynamics;
mod impulse;
mod jacobian;
mod projection;
mod relative_motion;
#[cfg(test)]
mod tests;

pub use delassus::ConstraintMemory;
pub use forward_dynamics::{ConstrainedForwardDynamics, constrained_forward_dynamics};
pub use impulse::change;
pub use impulse::{ConstraintImpulse, constraint_impulse};
pub(crate) use jacobian::wrench_of;
pub use jacobian::{ConstraintBias, ConstraintJacobian, ConstraintResidual, constraint_jacobian};
pub use projection::{ConstraintProjection, constraint_projection};
