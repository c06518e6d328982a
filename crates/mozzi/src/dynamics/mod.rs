//! Forces and accelerations: τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ̇).

mod base_parameters;
mod bias_forces;
mod closed_form;
mod coriolis_matrix;
mod energy;
mod forward_dynamics;
mod forward_dynamics_derivatives;
mod inverse_dynamics;
mod inverse_dynamics_derivatives;
mod joint_friction;
mod mass_matrix;
mod mass_matrix_solve;
mod momentum;
mod regressor;
mod task_space_dynamics;

#[cfg(test)]
pub(crate) mod tests;

pub use base_parameters::BaseParameters;
pub use bias_forces::{bias_forces, gravity_forces, tip_forces, velocity_product};
pub use closed_form::ClosedForm;
pub use coriolis_matrix::{coriolis_matrix, mass_matrix_rate};
pub use energy::{kinetic_energy, potential_energy};
pub use forward_dynamics::forward_dynamics;
pub use forward_dynamics_derivatives::forward_dynamics_derivatives;
pub use inverse_dynamics::inverse_dynamics;
pub use inverse_dynamics_derivatives::{
    gravity_forces_derivative, inverse_dynamics_derivatives, mass_matrix_product_derivative, tip_forces_derivative,
};
pub use joint_friction::joint_friction;
pub use mass_matrix::mass_matrix;
pub use mass_matrix_solve::forward_dynamics_by_mass_matrix;
pub use momentum::{momentum, momentum_matrix, momentum_rate, total_inertia};
pub use regressor::{energy_regressors, regressor};
pub use task_space_dynamics::{TaskMemory, task_space_dynamics};
