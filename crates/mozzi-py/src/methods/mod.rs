//! Methods of Python's `Model`: files, the quantities, edits, pages.

mod attach;
mod closed_form;
mod constrained_dynamics;
mod constraints;
mod directional;
mod documentation;
mod edits;
mod hints;
mod load;
mod play;
mod positions;
mod properties;
pub mod quantity;
mod report;
mod save;
mod states;

pub use attach::add_to;
