//! Tables of states and of results in files: .npy, .npz, Arrow, CSV.

pub mod array;
pub mod arrow;
pub mod format;
pub mod npy;
pub mod npz;
pub mod precision;
pub mod results;
pub mod samples;
pub mod states;
