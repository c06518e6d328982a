//! A file, or standard input for `-`, read no further than a bound if its length is unknown.

use crate::failure::{Failure, Result};
use mozzi_urdf::files;
use std::io::{self, Read};
use std::path::Path;
use std::sync::OnceLock;

/// Largest number of bytes from a pipe or a device, such as /dev/zero, which may never end.
const STREAM: u64 = 2 << 30;

/// A larger robot is refused.
const ROBOT: u64 = 256 << 20;

static ROBOT_TEXT: OnceLock<Vec<u8>> = OnceLock::new();

/// Standard input as the text of a robot, which is read once and used several times.
pub fn robot_text() -> io::Result<&'static [u8]> {
    if let Some(text) = ROBOT_TEXT.get() {
        return Ok(text);
    }
    let mut text = Vec::new();
    io::stdin().lock().take(ROBOT).read_to_end(&mut text)?;
    Ok(ROBOT_TEXT.get_or_init(|| text))
}

/// The text of a robot's file, or of standard input for `-`; a pipe is read once and its text kept.
pub fn robot_file(name_or_path: &str) -> Result<String> {
    let bytes = match name_or_path {
        "-" => robot_text().map(<[u8]>::to_vec),
        path => files::read_start(Path::new(path), ROBOT),
    };
    to_text(name_or_path, bytes.map_err(|error| cannot(name_or_path, &error))?)
}

pub struct Input {
    reader: Box<dyn Read>,
    /// Bytes of a file on a disk.
    length: Option<u64>,
    read: u64,
}

impl Input {
    pub fn open(file: &str) -> Result<Self> {
        if file == "-" {
            if ROBOT_TEXT.get().is_some() {
                return Err(Failure::wrong(
                    "standard input is the robot's file, expected the name of another file here",
                ));
            }
            return Ok(Input { reader: Box::new(io::stdin().lock()), length: None, read: 0 });
        }
        let opened = files::open(Path::new(file)).map_err(|error| cannot(file, &error))?;
        let found = opened.metadata().map_err(|error| cannot(file, &error))?;
        let length = found.is_file().then_some(found.len());
        Ok(Input { reader: Box::new(opened), length, read: 0 })
    }

    /// Bytes of a file on a disk that are still to be read; unknown for a pipe or a device.
    pub fn left(&self) -> Option<u64> {
        self.length.map(|length| length.saturating_sub(self.read))
    }
}

impl Read for Input {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(to)?;
        self.read += count as u64;
        match self.length.is_none() && self.read > STREAM {
            true => Err(io::Error::other(format!("a pipe or device gave more than {} GiB", STREAM >> 30))),
            false => Ok(count),
        }
    }
}

/// The name of a file in messages.
pub fn name(file: &str) -> &str {
    if file == "-" { "standard input" } else { file }
}

/// "table.csv cannot be read: …"
pub fn cannot(file: &str, error: &dyn std::fmt::Display) -> Failure {
    Failure::wrong(format!("{} cannot be read: {error}", name(file)))
}

/// A whole text, of limited length.
pub fn text(file: &str, most: usize) -> Result<String> {
    to_text(file, bytes(file, most)?)
}

/// The text of a file's bytes.
pub fn to_text(file: &str, bytes: Vec<u8>) -> Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        cannot(file, &format!("byte {} is not UTF-8 text", at + 1))
    })
}

/// All bytes, if there are at most this many.
pub fn bytes(file: &str, most: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = Input::open(file)?.take(most as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| cannot(file, &error))?;
    match bytes.len() > most {
        true => Err(cannot(file, &format!("it has more than {most} bytes, expected at most these"))),
        false => Ok(bytes),
    }
}
