//! zig as linker, for old versions of glibc; and the flags by which the same sources give the same binary: no path of
//! this machine is in it.

use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The oldest glibc that binaries for Linux run on: Debian 10, RHEL 8, Ubuntu 18.10.
pub const GLIBC: u32 = 28;

/// Lets a command find zig, which is a module of the first Python in PATH, and cargo-zigbuild.
pub fn find(workspace: &Workspace, command: &mut Command) -> Result<(), String> {
    let bin = venv::python(workspace).parent().map(Path::to_path_buf).unwrap_or_default();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(bin).chain(std::env::split_paths(&path)));
    command.env("PATH", path.map_err(|error| error.to_string())?);
    Ok(())
}

/// Lets a command build by cargo-zigbuild, without symbols: the same for everything that shares cargo's results.
pub fn prepare(workspace: &Workspace, command: &mut Command) -> Result<(), String> {
    find(workspace, command)?;
    command.env("CARGO_PROFILE_RELEASE_STRIP", "symbols").env("RUSTFLAGS", flags(&workspace.root));
    Ok(())
}

/// rustc's flags: those that are set, and the names that stand for the folders of this machine in panics' messages.
pub fn flags(root: &Path) -> String {
    let cargo = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let cargo = cargo.or_else(|| Some(std::env::home_dir()?.join(".cargo")));
    let folders = [(Some(root.to_owned()), "/mozzi"), (cargo, "/cargo")];
    let named = folders.into_iter().filter_map(|(folder, name)| Some((folder?, name)));
    let named = named.map(|(folder, name)| format!("--remap-path-prefix={}={name}", folder.display()));
    std::env::var("RUSTFLAGS").into_iter().chain(named).collect::<Vec<_>>().join(" ")
}
