//! Methods of Python's `Model`: the quantities, edits, pages.

#[macro_use]
mod quantities;

mod derivatives;
mod dynamics;
mod edits;
mod kinematics;
mod report;
mod to_look_at;
