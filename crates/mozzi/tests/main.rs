//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

mod long_chain;
mod modern_robotics;
mod refused;
mod sin_cos;
