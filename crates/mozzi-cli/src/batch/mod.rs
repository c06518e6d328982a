//! `mozzi batch`: files of states in, files of quantities out.

pub mod arrow;
pub mod compute;
pub mod format;
pub mod npy;
pub mod npz;
pub mod one_state;
pub mod quantity;
pub mod results;
pub mod states;
