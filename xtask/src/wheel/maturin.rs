//! maturin, in such a way that the same sources give the same file: no path of this machine and no time of the build is
//! in it.

use super::PACKAGE;
use crate::command;
use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The oldest systems that the wheel is for: glibc 2.28, as Debian 10, RHEL 8 and Ubuntu 18.10 have it.
const COMPATIBILITY: &str = "manylinux_2_28";

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
    maturin.args(["--release", "--strip"]);
    if cfg!(target_os = "linux") {
        maturin.args(["--zig", "--compatibility", COMPATIBILITY]);
    }
    if sources.offline {
        maturin.env("CARGO_NET_OFFLINE", "true");
    }
    command::run(maturin.env("CARGO_TARGET_DIR", &sources.target).env("RUSTFLAGS", flags(&sources.root)))
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
    // maturin finds zig as a module of the first Python in PATH
    let bin = venv::python(workspace).parent().map(Path::to_path_buf).unwrap_or_default();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(bin).chain(std::env::split_paths(&path)));
    maturin.env("PATH", path.map_err(|error| error.to_string())?);
    Ok(maturin)
}

/// rustc's flags: those that are set, and the names that stand for the folders of this machine in panics' messages.
fn flags(root: &Path) -> String {
    let cargo = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let cargo = cargo.or_else(|| Some(std::env::home_dir()?.join(".cargo")));
    let folders = [(Some(root.to_owned()), "/mozzi"), (cargo, "/cargo")];
    let named = folders.into_iter().filter_map(|(folder, name)| Some((folder?, name)));
    let named = named.map(|(folder, name)| format!("--remap-path-prefix={}={name}", folder.display()));
    std::env::var("RUSTFLAGS").into_iter().chain(named).collect::<Vec<_>>().join(" ")
}
