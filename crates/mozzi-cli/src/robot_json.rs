//! A robot's file of JSON from a path or from standard input: see [`mozzi_urdf::json`].

use crate::{input, json_file};
use mozzi::Description;
use mozzi_urdf::json::{self, Misplaced};

pub use mozzi_urdf::json::write;

/// True for a robot's JSON file. Decided by its name; for standard input, by whether it is an object.
pub fn is_json(name_or_path: &str) -> bool {
    if name_or_path == "-" {
        let text = input::robot_text().unwrap_or_default();
        return text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start().starts_with(b"{");
    }
    std::path::Path::new(name_or_path).extension().is_some_and(|suffix| suffix == "json")
}

/// # Errors
/// All unknown and missing keys, else the first other error.
pub fn read(file: &str) -> Result<Description, Vec<Misplaced>> {
    json::read(&json_file::read(file).map_err(|error| vec![error])?)
}
