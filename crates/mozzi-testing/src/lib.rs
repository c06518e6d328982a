//! References for testing mozzi: a [second way](SecondWay) to compute every quantity, numbers of [31 and 71
//! digits](wide) for both ways, and a [second reader](read_urdf) of URDF that keeps every digit of the file.
//!
//! [`accuracy`] measures the errors of every quantity in every way against them: `cargo xtask accuracy`. [`campaign`]
//! compares the ways on random robots: `cargo xtask campaign`. Not published: other crates depend on it in tests.

pub mod accuracy;
pub mod bodies;
mod by_robot;
pub mod campaign;
mod constraints;
mod given;
mod linear;
mod second_way;
mod urdf;
pub mod wide;

pub use given::Given;
pub use linear::{inverse, solve};
pub use mozzi_symbolic::NotRead;
pub use second_way::{SecondWay, second_way, second_way_of_f64};
pub use urdf::read_urdf;
pub use wide::{Double, Octuple, Wide};
