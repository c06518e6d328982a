//! Every quantity in every way, and other libraries, against numbers of 31 and 71 digits: the program of
//! `mozzi-testing`.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;

/// The program's arguments unless other robots are named.
const PAGE: &str = "docs/accuracy.md";

pub fn run(workspace: &Workspace, options: &[&str]) -> Outcome {
    let mut cargo = workspace.cargo(&["run", "--release", "--package", "mozzi-testing", "--"]);
    cargo.args(options);
    let python = venv::python(workspace);
    if python.is_file() {
        cargo.arg("--python").arg(python);
    }
    let names_robots = options.iter().any(|option| option.starts_with("--robots"));
    if let (false, Some(robots)) = (names_robots, oracles::robots(workspace)) {
        cargo.arg("--published").arg(robots);
    }
    if !options.iter().any(|option| ["--robots", "--quantities", "--page"].iter().any(|part| option.starts_with(part)))
    {
        cargo.arg("--page").arg(workspace.path(PAGE));
    }
    command::outcome(&mut cargo)
}
