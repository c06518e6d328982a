//! Tables of states and of results in files: .npy, .npz, Arrow, Parquet, CSV.

pub mod array;
#[cfg(feature = "arrow")]
pub mod arrow;
mod bound;
pub mod format;
pub mod npy;
pub mod npz;
#[cfg(feature = "parquet")]
mod parquet;
pub mod precision;
pub mod read;
pub mod results;
pub mod samples;
pub mod states;
