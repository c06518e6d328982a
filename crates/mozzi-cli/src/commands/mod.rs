//! One file for each subcommand: convert, check, call, name the error.

pub mod batch;
pub mod bench;
pub mod check;
pub mod codegen;
pub mod compare;
pub mod convert;
pub mod derivatives;
pub mod explain;
pub mod forward_dynamics;
pub mod ik;
pub mod info;
pub mod inverse_dynamics;
pub mod plot;
pub mod python;
pub mod screws;
pub mod simulate;
pub mod simulate_page;
pub mod stacked;
pub mod terms;
pub mod terms_json;
pub mod terms_text;
pub mod tour;
pub mod trajectories;
pub mod trajectory;
pub mod view;
