//! Where things are, and how to call cargo there.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is built in besides the defaults wherever tests are built, once and for all of them: each choice is a build of
/// its own.
pub const FEATURES: [&str; 2] = ["--features", "mozzi-cli/mcap,mozzi-cli/parquet,mozzi-cli/png"];

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

    /// Where cargo puts what it builds.
    pub fn target(&self) -> PathBuf {
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| self.path("target"), |target| self.root.join(target))
    }

    /// That folder, made anew and empty.
    pub fn fresh_folder(&self, relative: &str) -> Result<PathBuf, String> {
        let folder = self.path(relative);
        let remove = if folder.exists() { std::fs::remove_dir_all(&folder) } else { Ok(()) };
        let made = remove.and_then(|()| std::fs::create_dir_all(&folder));
        made.map(|()| folder).map_err(|error| format!("{relative}: {error}"))
    }

    /// An empty folder for a program that writes where it is started.
    pub fn scratch(&self, name: &str) -> Result<PathBuf, String> {
        self.fresh_folder(&format!("target/xtask/{name}"))
    }

    /// The same cargo that started this program, in the workspace's root.
    pub fn cargo(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")));
        command.args(arguments).current_dir(&self.root);
        command
    }

    /// `cargo run` of something in this workspace, started in another folder.
    pub fn cargo_run_in(&self, folder: &Path, arguments: &[&str]) -> Command {
        let mut command = self.cargo(&["run", "--manifest-path"]);
        command.arg(self.path("Cargo.toml")).args(arguments).current_dir(folder);
        command
    }
}
