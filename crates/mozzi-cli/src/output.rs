//! An output file: written next to its place, and renamed when it is complete. A full disk, an error or Ctrl-C leaves
//! an older file as it is.

use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use crate::terminal;
use mozzi_report::whole_file::WholeFile;
use mozzi_urdf::files;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

pub struct Output {
    file: String,
    whole: WholeFile,
    _writing: Writing,
}

/// The files that this command has written.
static WRITTEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn written() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Output {
    /// Begins a file that this command has neither read nor written.
    pub fn create(file: &str) -> Result<Self> {
        let path = Path::new(file);
        let is_written = path.is_file() && path.canonicalize().is_ok_and(|path| written().contains(&path));
        if is_written || path.is_file() && files::was_read(path) {
            let why = if is_written { "was written by this command already" } else { "was read by this command" };
            return Err(Failure::wrong(format!("{file} {why} and would be lost, expected another name")));
        }
        Self::replacing(file)
    }

    /// Begins a file that may be one that was read.
    pub fn replacing(file: &str) -> Result<Self> {
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
        self.whole.finish().map_err(|error| failed(&self.file, &error))?;
        written().extend(Path::new(&self.file).canonicalize());
        Ok(())
    }
}

/// Writes a file's text to standard output as it is; to a terminal without control characters.
pub fn to_stdout(text: &str) -> Result<()> {
    let mut to = io::stdout().lock();
    let text = if to.is_terminal() { terminal::result(text) } else { text.to_string() };
    match to.write_all(text.as_bytes()).and_then(|()| to.flush()) {
        // the reader has closed the pipe
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(failed("standard output", &error)),
        _ => Ok(()),
    }
}

pub fn failed(file: &str, error: &io::Error) -> Failure {
    Failure::wrong(format!("{file} cannot be written: {error}"))
}
