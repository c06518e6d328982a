//! Why a command fails.

use crate::terminal;
use mozzi_urdf::{Diagnostic, LoadError, Style};
use std::io::{IsTerminal, Write};

#[derive(Debug)]
pub enum Failure {
    /// A message: the name, its value, its place, and what was expected.
    Wrong(String),
    /// The robot's file is wrong.
    Load(Box<LoadError>),
    /// A negative result, on standard output: something is wrong.
    Answered(String),
    /// Stopped by Ctrl-C; the results so far, for standard output.
    Stopped(String),
}

pub type Result<T, E = Failure> = std::result::Result<T, E>;

impl Failure {
    pub fn wrong(sentence: impl Into<String>) -> Self {
        Failure::Wrong(sentence.into())
    }

    /// Prints the error on standard error.
    pub fn say(&self) {
        match self {
            Failure::Wrong(sentence) => write(&format!("error: {sentence}\n")),
            Failure::Load(error) if error.diagnostics().is_empty() => write(&format!("error: {error}\n")),
            Failure::Load(error) => write_styled(&(error.pretty(style()) + "\n")),
            Failure::Answered(_) | Failure::Stopped(_) => {}
        }
    }
}

/// Writes to standard error, ignoring errors if it is closed.
pub fn write(text: &str) {
    write_styled(&terminal::message(text));
}

/// Writes a coloured text without other control characters to standard error.
fn write_styled(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Diagnostics with their places in the file, on standard error; those about one element are one block.
pub fn say<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>) {
    write_styled(&mozzi_urdf::pretty(diagnostics, style()));
}

/// Uses colours if standard error is a terminal and NO_COLOR is not set (see no-color.org).
fn style() -> Style {
    let plain = !std::io::stderr().is_terminal() || std::env::var_os("NO_COLOR").is_some();
    if plain { Style::Unicode } else { Style::Color }
}

/// Prints a note on standard error.
pub fn note(text: &str) {
    write(&format!("note: {text}\n"));
}

impl From<mozzi::Error> for Failure {
    fn from(error: mozzi::Error) -> Self {
        match &error {
            mozzi::Error::NoEndEffector { leaves } if !leaves.is_empty() => {
                Failure::Wrong(format!("{error}; name one by --frame {}", leaves[0]))
            }
            _ => Failure::Wrong(error.to_string()),
        }
    }
}

impl From<mozzi_sim::Error> for Failure {
    fn from(error: mozzi_sim::Error) -> Self {
        Failure::Wrong(error.to_string())
    }
}

impl From<mozzi_engine::Error> for Failure {
    fn from(error: mozzi_engine::Error) -> Self {
        Failure::Wrong(error.to_string())
    }
}

impl From<mozzi_gpu::Error> for Failure {
    fn from(error: mozzi_gpu::Error) -> Self {
        Failure::Wrong(error.to_string())
    }
}

impl From<mozzi_identify::Error> for Failure {
    fn from(error: mozzi_identify::Error) -> Self {
        Failure::Wrong(error.to_string())
    }
}

impl From<mozzi_motion::Error> for Failure {
    fn from(error: mozzi_motion::Error) -> Self {
        Failure::Wrong(error.to_string())
    }
}

impl From<mozzi_urdf::constraints::ConstraintsError> for Failure {
    fn from(error: mozzi_urdf::constraints::ConstraintsError) -> Self {
        Failure::Wrong(error.to_string().replace('\n', "\nerror: "))
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Failure::Load(Box::new(error))
    }
}
