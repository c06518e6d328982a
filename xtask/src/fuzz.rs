//! Runs each fuzz target with its plain driver for `MOZZI_FUZZ_SECONDS` (5 by default).

use crate::command;
use crate::report::Outcome;
use crate::workspace::{FEATURES, Workspace};

pub fn run(workspace: &Workspace, seconds: Option<u32>) -> Outcome {
    // Built for the whole workspace, like the tests before: a smaller set of packages would enable fewer features and
    // rebuild everything.
    let mut cargo = workspace.cargo(&["test", "--workspace", "--test", "fuzz"]);
    if let Some(seconds) = seconds {
        cargo.env("MOZZI_FUZZ_SECONDS", seconds.to_string());
    }
    command::outcome(cargo.args(FEATURES).args(["--", "--ignored", "--nocapture"]))
}
