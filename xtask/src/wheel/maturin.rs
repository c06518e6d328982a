//! maturin, in such a way that the same sources give the same file: no path of this machine and no time of the build is
//! in it.

use super::{PACKAGE, only_file};
use crate::command;
use crate::venv;
use crate::workspace::Workspace;
use crate::zig;
use std::path::{Path, PathBuf};
use std::process::Command;

const RECOMPRESS: &str = "xtask/src/wheel/recompress.py";

/// Where a wheel is built.
pub struct Sources {
    /// The folder with Cargo.lock.
    pub root: PathBuf,
    /// That of pyproject.toml.
    pub project: PathBuf,
    /// cargo's results.
    pub target: PathBuf,
    /// Whether cargo may use the network.
    pub offline: bool,
}

impl Sources {
    pub fn of_workspace(workspace: &Workspace) -> Sources {
        let (root, target) = (workspace.root.clone(), workspace.target());
        Sources { project: root.join(PACKAGE), root, target, offline: false }
    }
}

/// Builds a wheel into a folder.
pub fn build(workspace: &Workspace, sources: &Sources, to: &Path) -> Result<(), String> {
    let mut maturin = command(workspace, "build", &sources.project, to)?;
    if cfg!(target_os = "linux") {
        maturin.args(["--zig", "--compatibility"]).arg(format!("manylinux_2_{}", zig::GLIBC));
    }
    if sources.offline {
        maturin.env("CARGO_NET_OFFLINE", "true");
    }
    command::run(maturin.env("CARGO_TARGET_DIR", &sources.target).env("RUSTFLAGS", zig::flags(&sources.root)))?;
    recompress(workspace, &only_file(to)?)
}

/// By a better compressor than maturin's and pip's.
pub fn recompress(workspace: &Workspace, wheel: &Path) -> Result<(), String> {
    let mut python = Command::new(venv::python(workspace));
    command::run(python.arg(workspace.path(RECOMPRESS)).arg(wheel))
}

/// Writes the source distribution into a folder.
pub fn sdist(workspace: &Workspace, to: &Path) -> Result<(), String> {
    command::run(command(workspace, "sdist", &workspace.path(PACKAGE), to)?)
}

fn command(workspace: &Workspace, what: &str, project: &Path, to: &Path) -> Result<Command, String> {
    let mut maturin = Command::new(venv::python(workspace));
    maturin.current_dir(project).args(["-m", "maturin", what, "--out"]).arg(to);
    if let Some(seconds) = workspace.time_of_commit() {
        maturin.env("SOURCE_DATE_EPOCH", seconds);
    }
    zig::find(workspace, &mut maturin)?;
    Ok(maturin)
}
