//! The fuzz targets under their plain driver, for some seconds each, or `MOZZI_FUZZ_SECONDS` (5 where it is not set).

use crate::command;
use crate::report::Outcome;
use crate::workspace::{FEATURES, Workspace};

pub fn run(workspace: &Workspace, seconds: Option<u32>) -> Outcome {
    // Of the whole workspace, as the tests before: fewer packages would ask for fewer features, and everything would be
    // built again.
    let mut cargo = workspace.cargo(&["test", "--workspace", "--test", "fuzz"]);
    if let Some(seconds) = seconds {
        cargo.env("MOZZI_FUZZ_SECONDS", seconds.to_string());
    }
    command::outcome(cargo.args(FEATURES).args(["--", "--ignored", "--nocapture"]))
}
