//! Results of the methods with several outputs.

mod derivatives;
mod newton_euler;
mod task_space;
mod vjp;

pub use derivatives::{ForwardDynamicsDerivatives, InverseDynamicsDerivatives};
pub use newton_euler::{BodyFrame, NewtonEuler};
pub use task_space::TaskSpaceDynamics;
pub use vjp::{EnergyGradients, ForwardDynamicsVjp, InverseDynamicsVjp, ParameterVjp};
