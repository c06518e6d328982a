//! The robots, the states and the quantities of every benchmark.

pub mod robots;
mod states;

pub use states::{State, States, inputs};

/// The quantities of the tables, in their order.
pub const QUANTITIES: [&str; 8] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "coriolis_matrix",
    "bias_forces",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "constrained_forward_dynamics",
];
