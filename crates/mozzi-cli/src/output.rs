//! An output file: written next to its place, and renamed when it is complete. A full disk, an error or Ctrl-C leaves
//! an older file as it is.

use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use mozzi_report::whole_file::WholeFile;
use std::fs::File;
use std::io;
use std::path::Path;

pub struct Output {
    file: String,
    whole: WholeFile,
    _writing: Writing,
}

impl Output {
    pub fn create(file: &str) -> Result<Self> {
        let whole = WholeFile::create(Path::new(file)).map_err(|error| failed(file, &error))?;
        let writing = Writing::to(file, whole.part());
        Ok(Output { file: file.to_string(), whole, _writing: writing })
    }

    /// The file handle to write to.
    pub fn handle(&self) -> io::Result<File> {
        self.whole.handle()
    }

    /// Writes the whole file, and moves it to its place.
    pub fn write(self, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
        match self.handle().and_then(|mut to| write(&mut to)) {
            Ok(()) => self.finish(),
            Err(error) => Err(failed(&self.file, &error)),
        }
    }

    /// Moves the complete file to its place.
    pub fn finish(self) -> Result<()> {
        self.whole.finish().map_err(|error| failed(&self.file, &error))
    }
}

pub fn failed(file: &str, error: &io::Error) -> Failure {
    Failure::wrong(format!("{file} cannot be written: {error}"))
}
