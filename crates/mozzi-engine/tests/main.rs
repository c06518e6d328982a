//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

mod casadi;
mod common;
mod compiled;
mod compiled_simulation;
mod conformance;
mod controller;
mod directional;
mod emitted;
mod harness;
mod machine_code;
mod machine_code_arrays;
mod many_states;
mod programs;
mod quantities_page;
mod refused;
mod rollouts;
mod rule;
mod sticking;
mod ways;
