//! The groups SO(3) and SE(3), their adjoint maps, and the only small-angle code.

mod adjoint;
mod rpy;
mod se3;
pub(crate) mod series;
mod so3;

pub use adjoint::{Adjoint, AdjointTranspose, LieBracket, LieBracketTranspose};
pub use se3::{InvalidConfiguration, SE3};
pub use so3::{InvalidRotation, SO3};
