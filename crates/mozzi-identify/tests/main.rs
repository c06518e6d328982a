//! The tests in one program: each links the crate and all that it needs.

mod common;
mod friction;
mod mistakes;
mod real_logs;
mod semidefinite;
mod sensor;
mod simulated;
