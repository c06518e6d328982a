//! Compares mozzi with Pinocchio and MuJoCo on a robot's file, and explains differences.
//!
//! [`compare`] runs each library in a Python process of its own and gets M, g, h and τ at random states. If they differ
//! from mozzi's, it searches for the causes: numbers that only one side reads, and conventions. A cause counts only if
//! the difference vanishes with it and returns without it.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mozzi_report::compare::{Options, Source, compare};
//! let model = mozzi_urdf::load("panda.urdf")?.build()?;
//! let comparison = compare(&model, Source::read("panda.urdf", model.description())?, &Options::default())?;
//! print!("{}", comparison.text());
//! assert!(comparison.is_explained());
//! # Ok(()) }
//! ```

mod answer;
mod bodies;
mod cause;
mod comparison;
mod constants;
mod convention;
mod error;
pub mod files;
mod numbers;
mod python;
mod question;
mod report_json;
mod report_text;
mod source;
mod state;
mod terms;
#[cfg(test)]
mod tests;
mod verdict;
mod vocabulary;

pub use comparison::{Comparison, Options, TIME_LIMIT, ask, compare};
pub use error::Error;
pub use numbers::BOUND;
pub use python::find as find_python;
pub use source::Source;

type Result<T> = std::result::Result<T, Error>;
