//! Reading of files: those that another file names must be regular and are of bounded size, and every file that was
//! read is remembered, so that a program does not overwrite it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files that were read; none until [`remember`] is called.
static KNOWN: Mutex<Option<BTreeSet<Identity>>> = Mutex::new(None);
/// Contents of pipes, which can be read once only, such as a shell's `<(command)`.
static PIPES: Mutex<BTreeMap<PathBuf, Vec<u8>>> = Mutex::new(BTreeMap::new());

/// A file, whatever path leads to it: device and number, or its path without links.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Identity {
    #[cfg(unix)]
    Number(u64, u64),
    #[cfg(not(unix))]
    Path(PathBuf),
}

impl Identity {
    #[cfg(unix)]
    fn of(_: &Path, found: &Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt;
        Some(Identity::Number(found.dev(), found.ino()))
    }

    #[cfg(not(unix))]
    fn of(path: &Path, _: &Metadata) -> Option<Self> {
        path.canonicalize().ok().map(Identity::Path)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on, files that are read are remembered.
pub fn remember() {
    lock(&KNOWN).get_or_insert_default();
}

/// Whether this file was read since [`remember`] was called; also by another path to it.
pub fn was_read(path: &Path) -> bool {
    let known = lock(&KNOWN);
    let identity = std::fs::metadata(path).ok().and_then(|found| Identity::of(path, &found));
    identity.is_some_and(|identity| known.as_ref().is_some_and(|known| known.contains(&identity)))
}

/// Whether two paths lead to one existing file.
pub fn are_same(a: &Path, b: &Path) -> bool {
    let identity = |path: &Path| Identity::of(path, &std::fs::metadata(path).ok()?);
    identity(a).is_some_and(|a| identity(b).is_some_and(|b| a == b))
}

/// Opens a file, and remembers it.
///
/// # Errors
/// The system's.
pub fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    let found = file.metadata()?;
    if found.is_file()
        && let (Some(known), Some(identity)) = (lock(&KNOWN).as_mut(), Identity::of(path, &found))
    {
        known.insert(identity);
    }
    Ok(file)
}

/// Reads a file that another file names: a regular file, since a pipe may never end.
///
/// # Errors
/// The system's; a file that is not regular, or of more than this many bytes, which is not read.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let found = std::fs::metadata(path)?;
    if !found.is_file() {
        return Err(io::Error::other("it is not a regular file, expected one"));
    }
    if found.len() > most {
        return Err(too_large(found.len(), most));
    }
    let mut bytes = Vec::new();
    open(path)?.take(most + 1).read_to_end(&mut bytes)?; // it may grow, or not tell its size, as in /proc
    if bytes.len() as u64 > most { Err(too_large(bytes.len() as u64, most)) } else { Ok(bytes) }
}

fn too_large(found: u64, most: u64) -> io::Error {
    io::Error::other(format!("it has {found} bytes, expected at most {most}"))
}

/// Reads a file or pipe that the user names, up to this many bytes. A pipe is read once; its content is kept.
///
/// # Errors
/// The system's; a folder.
pub fn read_start(path: &Path, count: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if std::fs::metadata(path)?.is_file() {
        open(path)?.take(count).read_to_end(&mut bytes)?;
        return Ok(bytes);
    }
    if let Some(known) = lock(&PIPES).get(path) {
        return Ok(known.clone());
    }
    open(path)?.take(count).read_to_end(&mut bytes)?;
    lock(&PIPES).insert(path.to_path_buf(), bytes.clone());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_bounded_and_remembered() {
        let folder = std::env::temp_dir().join(format!("mozzi-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let [a, b] = ["a", "b"].map(|name| folder.join(name));
        [&a, &b].iter().for_each(|path| std::fs::write(path, "0123456789").expect("a file"));
        assert_eq!(read(&b, 10).expect("small"), b"0123456789");
        remember();
        assert!(!was_read(&a) && !was_read(&b), "before they are remembered");
        assert_eq!(read(&a, 9).expect_err("large").to_string(), "it has 10 bytes, expected at most 9");
        assert_eq!(read(&folder, 9).expect_err("a folder").to_string(), "it is not a regular file, expected one");
        assert!(!was_read(&a));
        assert_eq!(read_start(&a, 4).expect("a file"), b"0123");
        assert!(was_read(&a) && was_read(&folder.join("../").join(folder.file_name().expect("one")).join("a")));
        assert!(!was_read(&b) && !was_read(&folder.join("c")) && !are_same(&a, &b) && are_same(&a, &a));
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
