//! The tests in one program: each links the crate and all that it needs.

mod library;
mod stubs;
