//! The main job, as a user starts it: `cargo run --release`, in an empty folder.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::process::{Child, Stdio};

/// The build for it, begun first. A failure is shown by [`run`], which builds again what is missing.
pub fn start_build(workspace: &Workspace) -> Option<Child> {
    let mut cargo = workspace.cargo(&["build", "--release", "--quiet"]);
    cargo.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
}

pub fn run(workspace: &Workspace, build: Option<Child>) -> Outcome {
    if let Some(mut build) = build {
        let _ = build.wait(); // its status does not matter: see `start_build`
    }
    match workspace.scratch("main_job") {
        Ok(folder) => command::outcome(workspace.cargo_run_in(&folder, &["--release"])),
        Err(why) => Outcome::Failed(why),
    }
}
