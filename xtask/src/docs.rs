//! The generated pages of `docs/` and the stubs of the Python package, written by the tests that otherwise check them.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::tests::give;
use crate::workspace::Workspace;

/// The tests that write pages.
const PAGES: [&str; 5] = ["reports", "published", "oracles", "quantities_page", "stubs"];

pub fn write(workspace: &Workspace) -> Outcome {
    let mut cargo =
        workspace.cargo(&["test", "--package", "mozzi-urdf", "--package", "mozzi-batch", "--package", "mozzi-py"]);
    for page in PAGES {
        cargo.args(["--test", page]);
    }
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    command::outcome(cargo.args(["--", "page"]).env("MOZZI_BLESS", "1"))
}
