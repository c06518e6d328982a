//! Forces and accelerations: τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇).
//!
//! One letter has one meaning in all kernels. Everything of a link i is in its own frame, whose z is the axis of its
//! joint; p is its parent. Numbers in brackets are the equations of Modern Robotics.
//!
//! | letter | in code | meaning |
//! |---|---|---|
//! | T_{i,i−1} | `T` | the parent's frame seen from the link (8.50) |
//! | A | `A` | the joint's screw axis, times the ratio of a mimic joint |
//! | 𝒱, 𝒱̇ | `V`, `dV` | twist and its rate (8.51), (8.52) |
//! | 𝓕 | `F` | wrench at the joint (8.53); felt with all joints beyond free, its bias |
//! | 𝒢, 𝒢ᶜ | `G` | spatial inertia of the link; with all links beyond it, which do not move against it |
//! | 𝓑, 𝓑ᶜ | `B` | 𝒢̇ + H(𝒢𝒱): `composite_bodies.rs` |
//! | Ĝ, c | `G_hat`, `c` | inertia with all joints beyond free; velocity-product acceleration |
//! | d, U, u | `d`, `U`, `u` | AᵀĜA + armature; ĜA/d; (τ − f − Aᵀ𝓕)/d |
//! | (r, s) | `by_theta`, `by_rates` | how an axis moves: the pair of ∂τ/∂θ; of ∂τ/∂θ̇ or C |
//! | X, Q, R | `X`, `Q`, `B.f` | how rates x move the link; 𝒢X; 𝓑ᵀX: `vjp.rs` |
//! | i, j; p | `i`, `link.j`; `p` | slot of a link, 0 the base; place of its joint in θ̇; the parent's slot |

mod armature;
mod base_parameters;
mod base_rates;
mod bias_forces;
mod center_of_mass;
mod centroidal_momentum;
mod closed_form;
mod composite_bodies;
mod coriolis_matrix;
mod derivatives;
mod energy;
mod energy_gradients;
mod force_derivatives;
mod forward_dynamics;
mod forward_dynamics_by_inverse_dynamics;
mod forward_dynamics_derivatives;
mod forward_dynamics_vjp;
mod frame_vjp;
mod inverse_dynamics;
mod inverse_dynamics_derivatives;
mod inverse_dynamics_vjp;
mod joint_friction;
mod long_limbs;
mod mass_matrix;
mod mass_matrix_inverse;
mod mass_matrix_product_vjp;
mod mass_matrix_solve;
mod momentum;
mod momentum_vjp;
mod parameter_vjp;
mod regressor;
mod several_axes;
mod siblings;
mod spring_forces;
mod task_space_dynamics;
mod vjp;

#[cfg(test)]
pub(crate) mod tests;

pub(crate) use armature::set_armature;
pub use base_parameters::BaseParameters;
pub use bias_forces::{
    BiasForces, GravityForces, TipForces, VelocityProduct, bias_forces, gravity_forces, tip_forces, velocity_product,
};
pub use center_of_mass::{
    CenterOfMass, CenterOfMassAcceleration, CenterOfMassJacobian, CenterOfMassVelocity, center_of_mass,
};
pub use centroidal_momentum::{CentroidalMomentumBias, CentroidalMomentumMatrix};
pub use closed_form::{ClosedForm, Entry};
pub(crate) use composite_bodies::composite_inertias;
pub use coriolis_matrix::{CoriolisMatrix, MassMatrixRate, coriolis_matrix, mass_matrix_rate};
pub use energy::{KineticEnergy, PotentialEnergy, kinetic_energy, potential_energy};
pub use energy_gradients::{EnergyGradients, energy_gradients};
pub use force_derivatives::{
    GravityForcesDerivative, MassMatrixProductDerivative, TipForcesDerivative, gravity_forces_derivative,
    mass_matrix_product_derivative, tip_forces_derivative,
};
pub use forward_dynamics::{ForwardDynamics, forward_dynamics};
pub use forward_dynamics_by_inverse_dynamics::ForwardDynamicsByInverseDynamics;
pub use forward_dynamics_derivatives::{ForwardDynamicsDerivatives, forward_dynamics_derivatives};
pub use forward_dynamics_vjp::{ForwardDynamicsVjp, forward_dynamics_vjp};
pub use frame_vjp::{FrameAccelerationVjp, FrameTwistVjp, frame_acceleration_vjp, frame_twist_vjp};
pub use inverse_dynamics::newton_euler;
pub use inverse_dynamics::{InverseDynamics, inverse_dynamics};
pub use inverse_dynamics_derivatives::{InverseDynamicsDerivatives, inverse_dynamics_derivatives};
pub use inverse_dynamics_vjp::{InverseDynamicsVjp, inverse_dynamics_vjp};
pub use joint_friction::{JointFriction, joint_friction};
pub(crate) use mass_matrix::fill_mass_matrix;
pub use mass_matrix::{MassMatrix, mass_matrix};
pub use mass_matrix_inverse::{MassMatrixInverse, mass_matrix_inverse};
pub use mass_matrix_product_vjp::{MassMatrixProductVjp, mass_matrix_product_vjp};
pub use mass_matrix_solve::{ForwardDynamicsByMassMatrix, forward_dynamics_by_mass_matrix};
pub use momentum::{Momentum, MomentumRate, momentum, momentum_matrix, momentum_rate, total_inertia};
pub use momentum_vjp::{MomentumRateVjp, MomentumVjp, momentum_rate_vjp, momentum_vjp};
pub use parameter_vjp::{
    ForwardDynamicsParameterVjp, InverseDynamicsParameterVjp, forward_dynamics_parameter_vjp,
    inverse_dynamics_parameter_vjp,
};
pub use regressor::{EnergyRegressors, Regressor, energy_regressors, regressor};
pub use spring_forces::add_spring_forces;
pub use spring_forces::{SpringForces, spring_forces};
pub use task_space_dynamics::{TaskSpaceDynamics, task_space_dynamics};
