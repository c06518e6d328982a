//! The generated pages of `docs/`, the stubs of the Python package, and the C and C++ headers, written by the tests
//! that otherwise check them.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::tests::give;
use crate::workspace::Workspace;

/// The test programs among whose tests are those that write pages: "page" is in their names.
const PROGRAMS: [&str; 2] = ["all", "header"];
/// Their packages.
const PACKAGES: [&str; 4] = ["mozzi-urdf", "mozzi-engine", "mozzi-py", "mozzi-c"];

pub fn write(workspace: &Workspace) -> Outcome {
    let mut cargo = workspace.cargo(&["test"]);
    for package in PACKAGES {
        cargo.args(["--package", package]);
    }
    for program in PROGRAMS {
        cargo.args(["--test", program]);
    }
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    command::outcome(cargo.args(["--", "page"]).env("MOZZI_BLESS", "1"))
}
