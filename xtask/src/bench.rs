//! The benchmarks, a package of their own.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

pub fn run(workspace: &Workspace) -> Outcome {
    if !workspace.path("benches/Cargo.toml").exists() {
        return Outcome::Skipped("there is no benches/Cargo.toml yet".into());
    }
    command::outcome(workspace.cargo(&["bench", "-p", "mozzi-benches"]))
}
