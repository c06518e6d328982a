//! Python calls compared with those of Pinocchio and the Modern Robotics package.

use crate::command;
use crate::package;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;

/// Builds the package in release mode and writes the table.
pub fn run(workspace: &Workspace) -> Outcome {
    match try_run(workspace) {
        Ok(()) => Outcome::Passed("target/bench/PYTHON.md".into()),
        Err(why) => Outcome::Failed(why),
    }
}

fn try_run(workspace: &Workspace) -> Result<(), String> {
    if let Outcome::Failed(why) = venv::prepare(workspace) {
        return Err(why);
    }
    let folder = workspace.path("target/python-release");
    package::put_together(workspace, &folder, &["build", "--release", "-p", "mozzi-py"], "release")?;
    let out = workspace.path("target/bench");
    std::fs::create_dir_all(&out).map_err(|error| format!("target/bench: {error}"))?;
    let mut python = std::process::Command::new(venv::python(workspace));
    python.env("PYTHONPATH", &folder).arg(workspace.path("crates/mozzi-py/benches/table.py"));
    command::run(python.arg(out.join("PYTHON.md")))
}
