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
pub(crate) mod bias_forces;
pub(crate) mod center_of_mass;
pub(crate) mod centroidal_momentum;
mod closed_form;
mod composite_bodies;
pub(crate) mod coriolis_matrix;
mod derivatives;
pub(crate) mod energy;
pub(crate) mod energy_gradients;
pub(crate) mod force_derivatives;
pub(crate) mod forward_dynamics;
pub(crate) mod forward_dynamics_by_inverse_dynamics;
pub(crate) mod forward_dynamics_derivatives;
pub(crate) mod forward_dynamics_vjp;
pub(crate) mod frame_vjp;
pub(crate) mod inverse_dynamics;
pub(crate) mod inverse_dynamics_derivatives;
pub(crate) mod inverse_dynamics_vjp;
pub(crate) mod joint_friction;
mod long_limbs;
pub(crate) mod mass_matrix;
pub(crate) mod mass_matrix_inverse;
pub(crate) mod mass_matrix_product_vjp;
pub(crate) mod mass_matrix_solve;
pub(crate) mod momentum;
pub(crate) mod momentum_vjp;
pub(crate) mod parameter_vjp;
pub(crate) mod regressor;
mod several_axes;
mod siblings;
pub(crate) mod spring_forces;
pub(crate) mod task_space_dynamics;
mod vjp;

#[cfg(test)]
pub(crate) mod tests;

pub(crate) use armature::set_armature;
pub use base_parameters::BaseParameters;
pub use bias_forces::{bias_forces, gravity_forces, tip_forces, velocity_product};
pub use center_of_mass::center_of_mass;
pub use closed_form::{ClosedForm, Entry};
pub(crate) use composite_bodies::composite_inertias;
pub use coriolis_matrix::{coriolis_matrix, mass_matrix_rate};
pub use energy::{kinetic_energy, potential_energy};
pub use energy_gradients::energy_gradients;
pub use force_derivatives::{gravity_forces_derivative, mass_matrix_product_derivative, tip_forces_derivative};
pub use forward_dynamics::forward_dynamics;
pub use forward_dynamics_derivatives::forward_dynamics_derivatives;
pub use forward_dynamics_vjp::forward_dynamics_vjp;
pub use frame_vjp::{frame_acceleration_vjp, frame_twist_vjp};
pub use inverse_dynamics::inverse_dynamics;
pub use inverse_dynamics::newton_euler;
pub use inverse_dynamics_derivatives::inverse_dynamics_derivatives;
pub use inverse_dynamics_vjp::inverse_dynamics_vjp;
pub use joint_friction::joint_friction;
pub(crate) use mass_matrix::fill_mass_matrix;
pub use mass_matrix::mass_matrix;
pub use mass_matrix_inverse::mass_matrix_inverse;
pub use mass_matrix_product_vjp::mass_matrix_product_vjp;
pub use mass_matrix_solve::forward_dynamics_by_mass_matrix;
pub use momentum::{momentum, momentum_matrix, momentum_rate, total_inertia};
pub use momentum_vjp::{momentum_rate_vjp, momentum_vjp};
pub use parameter_vjp::{forward_dynamics_parameter_vjp, inverse_dynamics_parameter_vjp};
pub use regressor::{energy_regressors, regressor};
pub use spring_forces::add_spring_forces;
pub use spring_forces::spring_forces;
pub use task_space_dynamics::task_space_dynamics;
