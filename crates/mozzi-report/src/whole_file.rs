//! A file that is written next to its place, and renamed when it is complete. A full disk, an error or a killed program
//! leaves an older file as it is.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that is being written.
pub struct WholeFile {
    to: File,
    part: Option<Part>,
}

/// A temporary file next to its place; removed unless it is renamed.
struct Part {
    path: PathBuf,
    place: PathBuf,
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path); // after renaming there is no such file
    }
}

impl WholeFile {
    /// Begins a file. Pipes, devices, broken links and files in a folder without write permission are written in place.
    ///
    /// # Errors
    /// The system's: no folder, no permission, a file that is read-only.
    pub fn create(file: &Path) -> io::Result<Self> {
        let place = file.canonicalize().unwrap_or_else(|_| file.to_path_buf()); // a link stays a link
        let found = std::fs::metadata(&place).ok();
        if found.as_ref().is_some_and(|found| !found.is_file()) || place.is_symlink() {
            return Ok(WholeFile { to: File::create(&place)?, part: None });
        }
        if found.is_some() {
            OpenOptions::new().write(true).open(&place)?; // a file that is read-only stays
        }
        let (to, path) = match beside(&place) {
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied && found.is_some() => {
                return Ok(WholeFile { to: File::create(&place)?, part: None });
            }
            made => made?,
        };
        let part = Some(Part { path, place });
        if let Some(found) = found {
            to.set_permissions(found.permissions())?;
        }
        Ok(WholeFile { to, part })
    }

    /// The file handle to write to.
    ///
    /// # Errors
    /// The system's.
    pub fn handle(&self) -> io::Result<File> {
        self.to.try_clone()
    }

    /// The path of the temporary file; none if it is written in place.
    pub fn part(&self) -> Option<&Path> {
        self.part.as_ref().map(|part| part.path.as_path())
    }

    /// Renames the temporary file to its place.
    ///
    /// # Errors
    /// The system's, such as a full disk; the older file is then unchanged.
    pub fn finish(self) -> io::Result<()> {
        let Some(part) = &self.part else { return Ok(()) };
        // some disks report only now that they are full
        self.to.sync_all().and_then(|()| std::fs::rename(&part.path, &part.place))
    }
}

/// Writes a whole file.
///
/// # Errors
/// The system's; an older file is then unchanged.
pub fn save(file: &Path, content: &[u8]) -> io::Result<()> {
    let whole = WholeFile::create(file)?;
    whole.handle()?.write_all(content)?;
    whole.finish()
}

/// A new file in the folder of another.
fn beside(place: &Path) -> io::Result<(File, PathBuf)> {
    let id = std::process::id();
    let mut k = 0;
    loop {
        let path = place.with_file_name(format!(".mozzi-{id}-{k}.part"));
        match OpenOptions::new().write(true).read(true).create_new(true).open(&path) {
            // left by a killed program
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && k < 1000 => k += 1,
            made => return Ok((made?, path)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_older_file_stays_until_the_new_one_is_whole() {
        let folder = std::env::temp_dir().join(format!("mozzi-whole-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("a.txt");
        let text = || std::fs::read_to_string(&file).expect("a file");
        save(&file, b"old").expect("saved");
        let begun = WholeFile::create(&file).expect("begun");
        begun.handle().and_then(|mut to| to.write_all(b"half")).expect("written");
        assert_eq!((text().as_str(), begun.part().is_some_and(Path::is_file)), ("old", true));
        drop(begun);
        save(&file, b"new").expect("saved");
        assert_eq!((text().as_str(), folder.read_dir().expect("a folder").count()), ("new", 1));
        assert!(save(&folder.join("none/a.txt"), b"").is_err());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
