//! Random robots, every quantity in two ways: the program of `mozzi-testing`.

use crate::command;
use crate::nightly;
use crate::report::Outcome;
use crate::workspace::Workspace;

/// The page to which a row is added.
const PAGE: &str = "docs/campaign.md";

pub fn run(workspace: &Workspace, options: &[&str]) -> Outcome {
    let commit = workspace.git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    // a panic is a finding, not the end
    let unwind = ["--config", "profile.release.panic = \"unwind\""];
    let mut cargo = workspace.cargo(&["run", "--release", "--package", "mozzi-testing"]);
    cargo.args(unwind).args(["--", "campaign"]);
    cargo.args(["--date", &nightly::today(), "--commit", &commit]);
    if !options.iter().any(|option| option.starts_with("--page")) {
        cargo.arg("--page").arg(workspace.path(PAGE));
    }
    command::outcome(cargo.args(options))
}
