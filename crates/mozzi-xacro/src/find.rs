//! `$(find package)`: locates the folder of a ROS package.

use crate::expander::Expander;
use crate::fault::{Fault, Result};
use crate::files;
use std::path::{Path, PathBuf};

/// The number of bytes of a package.xml that are read for its name.
const MOST_MANIFEST: u64 = 1 << 20;
/// The number of entries of a folder that are checked.
const MOST_ENTRIES: usize = 4096;

impl Expander<'_> {
    /// The folder of a package: as given, from a ROS installation, or near the file that names it.
    pub fn find_package(&self, name: &str) -> Result<String> {
        self.budget.spend(64)?;
        if let Some((_, folder)) = self.given.packages.iter().find(|(known, _)| known == name) {
            return Ok(folder.to_string_lossy().into_owned());
        }
        let is_plain = !name.contains(['/', '\\']) && !name.starts_with('.');
        let found = Some(name).filter(|_| is_plain).and_then(|name| installed(name).or_else(|| self.nearby(name)));
        match found.unwrap_or_default().as_slice() {
            [folder] => Ok(folder.to_string_lossy().into_owned()),
            [folder, another, ..] => {
                let (one, two) = (folder.display(), another.display());
                self.warn(format!(
                    "the package `{name}` is in {one} and in {two}; the first is taken, `--package {name}=FOLDER` names another"
                ));
                Ok(folder.to_string_lossy().into_owned())
            }
            [] => Err(Fault::new(format!(
                "the package `{name}` was not found in AMENT_PREFIX_PATH, CMAKE_PREFIX_PATH, ROS_PACKAGE_PATH, or the \
                 folders around the file; `--package {name}=FOLDER` names its folder"
            ))),
        }
    }

    /// A folder around the file, or siblings of such a folder.
    fn nearby(&self, name: &str) -> Option<Vec<PathBuf>> {
        let open = self.open.borrow();
        open.iter().rev().find_map(|file| {
            let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let folder = folder.canonicalize().ok()?;
            folder.ancestors().find_map(|above| {
                let is_it = above.file_name().is_some_and(|own| own == name) || has_name(above, name);
                if is_it {
                    return Some(vec![above.to_path_buf()]);
                }
                in_folder(above, name)
            })
        })
    }
}

/// Searches the paths that ROS lists.
fn installed(name: &str) -> Option<Vec<PathBuf>> {
    let listed = |variable: &str| {
        let Some(list) = std::env::var_os(variable) else { return Vec::new() };
        std::env::split_paths(&list).filter(|folder| !folder.as_os_str().is_empty()).collect()
    };
    let share = |folder: PathBuf| Some(folder.join("share").join(name)).filter(|folder| folder.is_dir());
    let prefixes = listed("AMENT_PREFIX_PATH").into_iter().chain(listed("CMAKE_PREFIX_PATH"));
    let of_prefix = prefixes.filter_map(share).next().map(|folder| vec![folder]);
    of_prefix.or_else(|| {
        listed("ROS_PACKAGE_PATH").into_iter().find_map(|folder| {
            let is_it = folder.file_name().is_some_and(|own| own == name) && folder.is_dir() || has_name(&folder, name);
            if is_it { Some(vec![folder]) } else { in_folder(&folder, name) }
        })
    })
}

/// The folder of this name, else the folders with a package.xml of this name, else those one level farther down.
fn in_folder(folder: &Path, name: &str) -> Option<Vec<PathBuf>> {
    // the root of the file system holds no packages
    folder.parent()?;
    let direct = folder.join(name);
    if direct.is_dir() {
        return Some(vec![direct]);
    }
    let folders = |folder: &Path| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_ENTRIES);
        let mut folders: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
        folders.sort_unstable();
        folders
    };
    let beside = folders(folder);
    let some = |found: Vec<PathBuf>| Some(found).filter(|found| !found.is_empty());
    some(beside.iter().filter(|folder| has_name(folder, name)).cloned().collect()).or_else(|| {
        // a repository of several packages next to this one
        let inner = beside.iter().map(|folder| folder.join(name));
        some(inner.filter(|inner| inner.join("package.xml").is_file()).collect())
    })
}

/// True if the folder's package.xml has this name.
fn has_name(folder: &Path, name: &str) -> bool {
    let Ok(bytes) = files::read(&folder.join("package.xml"), MOST_MANIFEST) else { return false };
    let text = String::from_utf8_lossy(&bytes);
    let given = text.split_once("<name>").and_then(|(_, rest)| rest.split_once("</name>"));
    given.is_some_and(|(given, _)| given.trim() == name)
}
