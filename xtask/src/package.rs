//! The Python package as `pip` would install it, under `target/python`: the library that `cargo test` built, with the
//! files of `crates/mozzi-py/python`; and its tests.

use crate::command;
use crate::report::Outcome;
use crate::tests::{self, Count};
use crate::venv;
use crate::workspace::{FEATURES, Workspace};
use std::path::{Path, PathBuf};
use std::process::Command;

const SOURCES: &str = "crates/mozzi-py/python/mozzi";

/// The value of `PYTHONPATH`.
pub fn folder(workspace: &Workspace) -> PathBuf {
    workspace.path("target/python")
}

/// A Python that can import the package.
pub fn python(workspace: &Workspace) -> Command {
    let mut python = Command::new(venv::python(workspace));
    python.env("PYTHONPATH", folder(workspace));
    python
}

/// Assembles and tests the package.
pub fn test(workspace: &Workspace, count: &mut Count) -> Outcome {
    if let Err(why) = stage(workspace) {
        count.fail();
        return Outcome::Failed(why);
    }
    let mut pytest = python(workspace);
    pytest.current_dir(&workspace.root).args(["-m", "pytest", "-p", "no:cacheprovider", "-q"]);
    pytest.args(["-n", "auto", "--dist", "worksteal", "crates/mozzi-py/tests"]);
    tests::run_counted(&mut pytest, count, Count::add_pytest)
}

fn stage(workspace: &Workspace) -> Result<(), String> {
    // already built with the tests; a separate build would use other features of its dependencies
    let cargo = [&["test", "--quiet", "--workspace", "--no-run"], &FEATURES[..]].concat();
    put_together(workspace, &folder(workspace), &cargo, "debug")
}

/// The package in this folder, its library built by `cargo` with these arguments, in the profile of this name.
pub fn put_together(workspace: &Workspace, to: &Path, cargo: &[&str], profile: &str) -> Result<(), String> {
    command::run(workspace.cargo(cargo))?;
    let package = to.join("mozzi");
    let failed = |what: &Path, error: std::io::Error| format!("{}: {error}", what.display());
    if package.exists() {
        std::fs::remove_dir_all(&package).map_err(|error| failed(&package, error))?;
    }
    copy(&workspace.path(SOURCES), &package)?;
    let name = format!("{}_mozzi{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let built = workspace.target().join(profile).join("deps").join(&name);
    let module = if cfg!(windows) { "_mozzi.pyd" } else { "_mozzi.abi3.so" };
    std::fs::copy(&built, package.join(module)).map_err(|error| failed(&built, error))?;
    Ok(())
}

/// Copies a folder, except files that Python created there.
pub fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", from.display());
    std::fs::create_dir_all(to).map_err(failed)?;
    for entry in std::fs::read_dir(from).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let Some(name) = path.file_name().filter(|name| *name != "__pycache__") else { continue };
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            std::fs::copy(&path, to.join(name)).map_err(failed)?;
        }
    }
    Ok(())
}
