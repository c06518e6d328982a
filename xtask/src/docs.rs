//! The generated pages of `docs/`, the stubs of the Python package, and the C and C++ headers, written by the tests
//! that otherwise check them.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::tests::give;
use crate::workspace::Workspace;

/// The tests that write pages.
const PAGES: [&str; 6] = ["reports", "published", "oracles", "quantities_page", "stubs", "header"];
/// Their packages.
const PACKAGES: [&str; 4] = ["mozzi-urdf", "mozzi-batch", "mozzi-py", "mozzi-c"];

pub fn write(workspace: &Workspace) -> Outcome {
    let mut cargo = workspace.cargo(&["test"]);
    for package in PACKAGES {
        cargo.args(["--package", package]);
    }
    for page in PAGES {
        cargo.args(["--test", page]);
    }
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    command::outcome(cargo.args(["--", "page"]).env("MOZZI_BLESS", "1"))
}
