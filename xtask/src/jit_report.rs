//! `cargo xtask jit-report`: the instructions of machine code, counted, into docs/arm.md.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

const PAGE: &str = "docs/arm.md";

pub fn write(workspace: &Workspace) -> Outcome {
    let run = ["run", "--quiet", "--release", "--package", "mozzi-engine", "--example", "jit_report"];
    let text = match command::output(workspace.cargo(&run)) {
        Ok((true, text)) => text,
        Ok((false, _)) => return Outcome::Failed("the example jit_report of mozzi-engine failed".into()),
        Err(why) => return Outcome::Failed(why),
    };
    match std::fs::write(workspace.path(PAGE), text) {
        Ok(()) => Outcome::Passed(format!("wrote {PAGE}")),
        Err(error) => Outcome::Failed(format!("{PAGE}: {error}")),
    }
}
