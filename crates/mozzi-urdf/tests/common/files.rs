//! Files of a folder and of those in it.

use std::path::{Path, PathBuf};

/// All URDFs.
pub fn urdf_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path()) {
        if path.is_dir() {
            urdf_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "urdf") {
            files.push(path);
        }
    }
}
