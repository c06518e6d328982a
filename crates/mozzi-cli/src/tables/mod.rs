//! Tables of states and of results in files: .npy, .npz, Arrow, Parquet, CSV.

pub mod array;
#[cfg(feature = "arrow")]
pub mod arrow;
mod bound;
mod degrees;
pub mod format;
pub mod join;
pub mod motion;
pub mod npy;
pub mod npz;
#[cfg(feature = "parquet")]
mod parquet;
pub mod precision;
pub mod read;
pub mod results;
pub mod samples;
pub mod states;

use crate::failure;
use crate::recogniser::{Header, Recognised, Request};
use mozzi::Model;

/// How a table is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct How<'r> {
    pub request: Request<'r>,
    /// Whether cells without a number are NaN, as in logs, instead of an error.
    pub may_miss: bool,
}

/// The meaning of named columns.
fn recognised(file: &str, names: &[String], model: &Model, how: &How) -> failure::Result<Recognised> {
    let found = Recognised::find(file, &Header::of(names.to_vec()), model, &how.request)?;
    found.notes.iter().for_each(|note| failure::note(note));
    Ok(found)
}
