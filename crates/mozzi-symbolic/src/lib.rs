//! The equations of a robot on paper: mozzi's kernels on symbols.
//!
//! [`derive`](derive()) runs a quantity's kernel on `Model<Symbol>`, whose numbers are exact: the file's decimals as
//! rationals, symbols with the book's names for parameters, sines and cosines of sums of angles about parallel axes.
//! The sums are canonical polynomials; the shortest of several groupings is printed. Every printed expression is
//! compared with the kernel, exactly, at random rational points.

mod angles;
mod atom;
mod base_parameters;
mod collect;
mod constrained;
mod cse;
mod dependence;
mod derivation;
mod derive;
mod error;
mod evaluate;
mod expression;
mod fraction;
mod inverse;
mod kernel;
mod laurent;
mod letters;
mod minors;
mod offsets;
mod order;
mod parameters;
mod point;
mod polynomial;
mod print;
mod proof;
mod rational;
mod read;
mod rotation;
mod rounded;
mod sines;
mod steps;
mod symbol;
mod table;

pub use atom::{Class, Name};
pub use base_parameters::base_parameters;
pub use derivation::{Derivation, Formula};
pub use derive::{Collect, Options, derive};
pub use error::Error;
pub use expression::Operations;
pub use inverse::{dependent_rows, is_fraction};
pub use parameters::{Equal, Meaning, Symbols};
pub use print::{Language, print_all};
pub use rational::Rational;
pub use read::{At, NotRead, Part, agree, read_urdf};
pub use steps::{Step, Steps, steps};
pub use symbol::Symbol;
