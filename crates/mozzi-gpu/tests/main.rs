//! The tests in one program: each links the crate and all that it needs.

mod common;
mod device;
mod host;
mod nvrtc;
mod rollout;
