//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;
mod friction;
mod mistakes;
mod real_logs;
mod refine;
mod semidefinite;
mod sensor;
mod simulated;
mod stuck;
mod suspicion;
