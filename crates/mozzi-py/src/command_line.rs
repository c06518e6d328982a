//! The command `mozzi`, which `pip install mozzi` installs.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Run the command line with these words, the program's name first; return the exit code.
#[pyfunction]
pub fn _command_line(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| mozzi_cli::run_with(words))
}
