//! Files of a folder and of those in it.

use std::path::{Path, PathBuf};

/// All URDFs.
pub fn urdf_files(folder: &Path, files: &mut Vec<PathBuf>) {
    files_with_ending(folder, "urdf", files);
}

/// All files whose names end in `.` and an ending.
pub fn files_with_ending(folder: &Path, ending: &str, files: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path()) {
        if path.is_dir() {
            files_with_ending(&path, ending, files);
        } else if path.extension().is_some_and(|extension| extension == ending) {
            files.push(path);
        }
    }
}
