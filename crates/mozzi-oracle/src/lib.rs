//! What the tests measure mozzi by: every quantity a [second way](SecondWay), numbers of [31 and 71 digits](wide) that
//! both ways can be computed in, and a [second reader](read_urdf) of URDF that keeps every digit of the file.
//!
//! Not published: it depends on `mozzi` alone, whose crates depend on it in tests.

pub mod bodies;
mod constraints;
mod given;
mod linear;
mod second_way;
mod urdf;
pub mod wide;

pub use given::Given;
pub use linear::{inverse, solve};
pub use second_way::{SecondWay, second_way};
pub use urdf::{NotRead, read_urdf};
pub use wide::{Double, Octuple, Wide};
