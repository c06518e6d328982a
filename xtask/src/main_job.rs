//! The main job, as a user starts it: `cargo run --release`, in an empty folder.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

pub fn run(workspace: &Workspace) -> Outcome {
    match workspace.scratch("main_job") {
        Ok(folder) => command::outcome(workspace.cargo_run_in(&folder, &["--release"])),
        Err(why) => Outcome::Failed(why),
    }
}
