//! The fuzz targets under their plain driver, for `MOZZI_FUZZ_SECONDS` each (5 where it is not set).

use crate::command;
use crate::report::Outcome;
use crate::workspace::{FEATURES, Workspace};

pub fn run(workspace: &Workspace) -> Outcome {
    // Of the whole workspace, as the tests before: fewer packages would ask for fewer features, and everything would be
    // built again.
    let mut cargo = workspace.cargo(&["test", "--workspace", "--test", "fuzz"]);
    command::outcome(cargo.args(FEATURES).args(["--", "--ignored", "--nocapture"]))
}
