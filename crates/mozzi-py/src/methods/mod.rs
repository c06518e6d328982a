//! Methods of Python's `Model`: the quantities, edits, pages.

mod attach;
mod closed_form;
mod constraints;
mod documentation;
mod edits;
mod quantity;
mod report;
mod states;

pub use attach::add_to;
