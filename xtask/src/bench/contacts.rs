//! Steps with contacts beside MuJoCo's, by `benches/contacts.py`.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;
use std::process::Command;

const PAGE: &str = "benches/CONTACTS.md";
const HEAD: &str = "\
# A step with contacts

Milliseconds of a step of 1 ms, one thread, while a model falls with its motors off (the first second), and lies (the
third): mozzi's program, and MuJoCo's `mj_step` on the same file. MuJoCo's contacts are soft, its cone is convex; mozzi
solves Coulomb's law to rounding. The URDFs' robots fall from a height at which nothing touches. Gymnasium's models ask
MuJoCo for Runge-Kutta, four evaluations a step. Written by `cargo xtask bench --contacts`.

";

/// Builds the program and writes the table.
pub fn run(workspace: &Workspace) -> Outcome {
    try_run(workspace).map_or_else(Outcome::Failed, |()| Outcome::Passed(PAGE.into()))
}

fn try_run(workspace: &Workspace) -> Result<(), String> {
    if let Outcome::Failed(why) = venv::prepare(workspace) {
        return Err(why);
    }
    command::run(workspace.cargo(&["build", "--release", "--quiet"]))?;
    let mozzi = workspace.target().join("release").join(format!("mozzi{}", std::env::consts::EXE_SUFFIX));
    let mut python = Command::new(venv::python(workspace));
    python.arg(workspace.path("benches/contacts.py")).arg(mozzi);
    python.envs(oracles::robots(workspace).map(|robots| ("MOZZI_ROBOTS", robots)));
    let (succeeded, table) = command::output(&mut python)?;
    if !succeeded {
        return Err("benches/contacts.py failed: see above".into());
    }
    std::fs::write(workspace.path(PAGE), format!("{HEAD}{table}")).map_err(|error| format!("{PAGE}: {error}"))
}
