//! A file that is written: next to its place, and renamed when it is whole. A full disk, an error or Ctrl-C leaves an
//! older file as it is.

use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

pub struct Output {
    file: String,
    to: File,
    part: Option<Part>,
    _writing: Writing,
}

/// A file next to its place; removed unless it gets there.
struct Part {
    path: PathBuf,
    place: PathBuf,
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path); // after a renaming there is none
    }
}

impl Output {
    pub fn create(file: &str) -> Result<Self> {
        let cannot = |error: io::Error| failed(file, &error);
        let place = Path::new(file).canonicalize().unwrap_or_else(|_| PathBuf::from(file)); // a link stays a link
        let found = std::fs::metadata(&place).ok();
        if found.as_ref().is_some_and(|found| !found.is_file()) || place.is_symlink() {
            // a pipe or a device, or a link to nothing
            let to = File::create(&place).map_err(cannot)?;
            return Ok(Output { file: file.to_string(), to, part: None, _writing: Writing::to(file, None) });
        }
        if found.is_some() {
            OpenOptions::new().write(true).open(&place).map_err(cannot)?; // a file that is read-only stays
        }
        let (to, path) = match beside(&place) {
            Ok(made) => made,
            // of a folder that takes no new files
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied && found.is_some() => {
                let to = File::create(&place).map_err(cannot)?;
                return Ok(Output { file: file.to_string(), to, part: None, _writing: Writing::to(file, None) });
            }
            Err(error) => return Err(cannot(error)),
        };
        let writing = Writing::to(file, Some(&path));
        let part = Some(Part { path, place });
        if let Some(found) = found {
            to.set_permissions(found.permissions()).map_err(cannot)?;
        }
        Ok(Output { file: file.to_string(), to, part, _writing: writing })
    }

    /// What to write to.
    pub fn handle(&self) -> io::Result<File> {
        self.to.try_clone()
    }

    /// Writes all of it, and puts it in its place.
    pub fn write(self, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
        match self.handle().and_then(|mut to| write(&mut to)) {
            Ok(()) => self.finish(),
            Err(error) => Err(failed(&self.file, &error)),
        }
    }

    /// Puts it in its place.
    pub fn finish(self) -> Result<()> {
        let Some(part) = &self.part else { return Ok(()) };
        // some disks say only now that they are full
        let placed = self.to.sync_all().and_then(|()| std::fs::rename(&part.path, &part.place));
        placed.map_err(|error| failed(&self.file, &error))
    }
}

pub fn failed(file: &str, error: &io::Error) -> Failure {
    Failure::wrong(format!("{file} cannot be written: {error}"))
}

/// A new file in the folder of another.
fn beside(place: &Path) -> io::Result<(File, PathBuf)> {
    let id = std::process::id();
    let mut k = 0;
    loop {
        let path = place.with_file_name(format!(".mozzi-{id}-{k}.part"));
        match OpenOptions::new().write(true).read(true).create_new(true).open(&path) {
            // of a program that was killed
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && k < 1000 => k += 1,
            made => return Ok((made?, path)),
        }
    }
}
