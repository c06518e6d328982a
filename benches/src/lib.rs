//! The robots and the states that every benchmark uses.

pub mod random;
pub mod robots;
mod states;

pub use states::{State, States};
