//! One file for each subcommand: convert the arguments, check them, call the library, report errors.

pub mod assemble;
pub mod bench;
pub mod check;
pub mod codegen;
pub mod compare;
pub mod completions;
pub mod compute;
pub mod convert;
#[cfg_attr(not(feature = "derive"), path = "derive_absent.rs")]
pub mod derive;
pub mod excite;
pub mod explain;
pub mod identify;
pub mod ik;
pub mod info;
pub mod man;
pub mod outcome;
pub mod picture;
pub mod play;
pub mod plot;
pub mod python;
mod repairs;
pub mod robots;
pub mod screws;
pub mod simulate;
pub mod simulate_page;
pub mod terms;
pub mod tour;
pub mod trajectory;
pub mod view;
pub mod xacro;
