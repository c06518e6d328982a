//! The methods of [`Model`]: the kernels on `f64`. They return errors instead of panicking, and nalgebra's vectors and
//! matrices. They allocate; a control loop calls the kernels with its own memory.

pub(crate) mod constraints;
mod derivatives;
mod directional_derivative;
mod dynamics;
mod forward_dynamics;
mod kinematics;
mod momentum;
mod newton_euler;
mod regressor;
mod task_space;
mod vjp;

pub use constraints::{ConstrainedDynamics, ConstrainedForwardDynamicsDerivatives, ConstraintRank, Reduction};
pub use derivatives::{ForwardDynamicsDerivatives, InverseDynamicsDerivatives};
pub use newton_euler::{BodyFrame, NewtonEuler};
pub use task_space::TaskSpaceDynamics;
pub use vjp::{EnergyGradients, ForwardDynamicsVjp, InverseDynamicsVjp, ParameterVjp};
