//! The tests in one program: each links the crate and all that it needs.

mod allocation;
mod modern_robotics;
mod one_sided;
mod sin_cos;
