//! A file of JSON from a path or from standard input.

use crate::failure::{Failure, Result};
use crate::input;
use mozzi_urdf::json::{File, Misplaced};

/// A larger file is refused.
const MOST_BYTES: usize = 256 << 20;

/// Reads it; `-` is standard input, which contains the robot.
pub fn read(name: &str) -> std::result::Result<File, Misplaced> {
    let shown = input::name(name);
    let text = text(name).map_err(|failure| {
        let why = if let Failure::Wrong(why) = failure { why } else { String::from("cannot be read") };
        Misplaced::whole(shown, why.strip_prefix(&format!("{shown} ")).unwrap_or(&why))
    })?;
    File::parse(shown, text)
}

fn text(file: &str) -> Result<String> {
    match file {
        "-" => input::to_text(file, input::robot_text().map_err(|error| input::cannot(file, &error))?.to_vec()),
        file => input::text(file, MOST_BYTES),
    }
}

impl From<Misplaced> for Failure {
    fn from(error: Misplaced) -> Self {
        Failure::wrong(error.to_string())
    }
}

impl From<Vec<Misplaced>> for Failure {
    fn from(errors: Vec<Misplaced>) -> Self {
        Failure::wrong(errors.iter().map(Misplaced::to_string).collect::<Vec<_>>().join("\nerror: "))
    }
}
