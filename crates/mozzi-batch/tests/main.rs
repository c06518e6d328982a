//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../../mozzi-codegen/tests/common/mod.rs"]
mod common;
mod compiled;
mod compiled_simulation;
mod conformance;
mod directional;
mod machine_code_arrays;
mod many_states;
mod quantities_page;
mod refused;
mod rule;
mod sticking;
mod ways;
