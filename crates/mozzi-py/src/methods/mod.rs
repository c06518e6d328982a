//! The quantities, as methods of Python's `Model`.

mod derivatives;
mod dynamics;
mod kinematics;
mod report;
mod to_look_at;
