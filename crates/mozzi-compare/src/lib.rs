//! What Pinocchio and MuJoCo compute of a robot's file, and why it differs from what mozzi computes.
//!
//! [`compare`] asks each library, in a Python that has it, for M, g, h and τ at random states, in processes of their own. Where they differ
//! it looks for the causes: numbers that one side reads and the other does not, and conventions. A cause counts only if the difference goes
//! where it is accounted for, and comes back where it is not.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mozzi_compare::{Options, Source, compare};
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
mod error;
mod numbers;
mod python;
mod question;
mod report_json;
mod report_text;
mod source;
#[cfg(test)]
mod tests;
mod verdict;
mod vocabulary;

pub use comparison::{Comparison, Options, ask, compare};
pub use error::Error;
pub use numbers::BOUND;
pub use python::find as find_python;
pub use source::Source;

type Result<T> = std::result::Result<T, Error>;
