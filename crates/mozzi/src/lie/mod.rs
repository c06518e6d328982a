//! The groups SO(3) and SE(3), twists and wrenches, the adjoint maps between them, and the only small-angle code.

mod adjoint;
mod quaternion;
mod rotation_vector;
mod rpy;
mod se3;
pub(crate) mod series;
mod so3;
mod twist;
mod wrench;

pub(crate) use rotation_vector::RotationVector;

pub use adjoint::{Adjoint, AdjointTranspose, LieBracket, LieBracketTranspose};
pub(crate) use quaternion::length_off_unit;
pub use se3::{InvalidConfiguration, SE3};
pub use so3::{InvalidRotation, SO3};
pub use twist::Twist;
pub use wrench::Wrench;
