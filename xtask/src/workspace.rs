//! Paths of the workspace, and cargo calls in it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Features that are enabled in addition to the defaults wherever tests are built: the same set for all of them,
/// because each set needs a build of its own.
pub const FEATURES: [&str; 2] =
    ["--features", "mozzi-cli/arrow,mozzi-cli/mcap,mozzi-cli/parquet,mozzi-cli/pdf,mozzi-cli/png"];

pub struct Workspace {
    pub root: PathBuf,
}

impl Workspace {
    /// The folder above this package: cargo names it at run time, since a copied binary may have been built elsewhere.
    pub fn find() -> Self {
        let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        Self { root: Path::new(&package).parent().unwrap_or(Path::new(".")).to_owned() }
    }

    pub fn path(&self, relative: &str) -> PathBuf {
        self.root.join(relative)
    }

    /// The text of a file; the error names it.
    pub fn read(&self, relative: &str) -> Result<String, String> {
        std::fs::read_to_string(self.path(relative)).map_err(|error| format!("{relative}: {error}"))
    }

    /// A file's path from the root, with `/`.
    pub fn name_of(&self, file: &Path) -> String {
        file.strip_prefix(&self.root).unwrap_or(file).to_string_lossy().replace('\\', "/")
    }

    /// The folder of cargo's build results.
    pub fn target(&self) -> PathBuf {
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| self.path("target"), |target| self.root.join(target))
    }

    /// This folder, emptied or created.
    pub fn fresh_folder(&self, relative: &str) -> Result<PathBuf, String> {
        let folder = self.path(relative);
        let remove = if folder.exists() { std::fs::remove_dir_all(&folder) } else { Ok(()) };
        let made = remove.and_then(|()| std::fs::create_dir_all(&folder));
        made.map(|()| folder).map_err(|error| format!("{relative}: {error}"))
    }

    /// An empty folder for a program that writes to its working directory.
    pub fn scratch(&self, name: &str) -> Result<PathBuf, String> {
        self.fresh_folder(&format!("target/xtask/{name}"))
    }

    /// A call of the cargo that started this program, in the workspace's root.
    pub fn cargo(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")));
        command.args(arguments).current_dir(&self.root);
        command
    }

    /// The output of git, if this is a clone and git is installed.
    pub fn git(&self, arguments: &[&str]) -> Option<String> {
        let output = Command::new("git").args(arguments).current_dir(&self.root).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && !text.is_empty()).then_some(text)
    }

    /// The version of the published crates.
    pub fn version(&self) -> Result<String, String> {
        let text = std::fs::read_to_string(self.path("Cargo.toml")).map_err(|error| format!("Cargo.toml: {error}"))?;
        let version = text.lines().find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
        version.map(str::to_owned).ok_or_else(|| "Cargo.toml states no version".into())
    }

    /// SOURCE_DATE_EPOCH, the time that archives give their files: as set, or that of the last commit.
    pub fn time_of_commit(&self) -> Option<String> {
        std::env::var("SOURCE_DATE_EPOCH").ok().or_else(|| self.git(&["log", "-1", "--format=%ct"]))
    }

    /// `cargo run` of something in this workspace, started in another folder.
    pub fn cargo_run_in(&self, folder: &Path, arguments: &[&str]) -> Command {
        let mut command = self.cargo(&["run", "--manifest-path"]);
        command.arg(self.path("Cargo.toml")).args(arguments).current_dir(folder);
        command
    }
}

/// Adds a file, or the files of a folder and its subfolders, with one of these endings; `target` is left out.
pub fn files(path: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().filter_map(Result::ok);
        let inner =
            entries.map(|entry| entry.path()).filter(|path| path.file_name().is_some_and(|name| name != "target"));
        inner.for_each(|path| files(&path, endings, found));
    } else if path.extension().is_some_and(|ending| endings.iter().any(|known| ending == *known)) {
        found.push(path.to_path_buf());
    }
}
