//! The fuzz targets under their plain driver, for `MOZZI_FUZZ_SECONDS` each (5 where it is not set).

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

pub fn run(workspace: &Workspace) -> Outcome {
    let packages = ["--package", "mozzi-urdf", "--package", "mozzi-codegen"];
    let arguments = [&["test"], &packages[..], &["--test", "fuzz", "--", "--ignored", "--nocapture"]].concat();
    command::outcome(workspace.cargo(&arguments))
}
