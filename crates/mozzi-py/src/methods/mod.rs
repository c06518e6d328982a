//! Methods of Python's `Model`: the quantities, edits, pages.

#[macro_use]
mod quantities;

mod closed_form;
mod derivatives;
mod dynamics;
mod edits;
mod kinematics;
mod report;
