//! The tests in one program: each links the crate and all that it needs.
#![allow(clippy::unwrap_used, missing_docs)]

mod actuators;
mod attach;
mod common;
mod constraints;
mod damaged;
mod drake;
mod edit;
mod edit_files;
#[path = "common/files.rs"]
mod files;
mod floating;
mod formats;
mod freedoms;
mod keyframes;
mod meshes;
mod mjcf;
mod mjcf_writer;
mod oracles;
mod published;
mod refused;
mod repairs;
mod reports;
mod robots;
mod round_trip;
mod sdf;
mod transmissions;
mod xacro;
