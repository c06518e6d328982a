//! Checks the dependencies for known vulnerabilities, if cargo-deny or cargo-audit is installed and its database can be
//! fetched.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use serde_json::Value;

pub fn check(workspace: &Workspace) -> Outcome {
    if command::exists(&mut workspace.cargo(&["deny"])) {
        deny(workspace)
    } else if command::exists(&mut workspace.cargo(&["audit"])) {
        audit(workspace)
    } else {
        Outcome::Skipped("neither cargo-deny nor cargo-audit is installed".into())
    }
}

/// Fetches the database first, so that a missing network is not reported as a vulnerability.
fn deny(workspace: &Workspace) -> Outcome {
    match command::run(workspace.cargo(&["deny", "fetch", "db"])) {
        Ok(()) => command::outcome(workspace.cargo(&["deny", "check", "--disable-fetch", "advisories"])),
        Err(why) => Outcome::Skipped(format!("no advisory database: {why}")),
    }
}

/// Its report is JSON whenever there is one; without a database there is none.
fn audit(workspace: &Workspace) -> Outcome {
    let text = match command::output(workspace.cargo(&["audit", "--json"])) {
        Ok((_, text)) => text,
        Err(why) => return Outcome::Skipped(why),
    };
    let report: Value = serde_json::from_str(&text).unwrap_or_default();
    let Some(list) = report["vulnerabilities"]["list"].as_array() else {
        return Outcome::Skipped("cargo-audit gave no report: is its database out of reach?".into());
    };
    let name = |item: &Value| format!("{} in {}", item["advisory"]["id"], item["package"]["name"]).replace('"', "");
    match list.is_empty() {
        true => Outcome::Passed("cargo-audit knows of none".into()),
        false => Outcome::Failed(list.iter().map(name).collect::<Vec<_>>().join(", ")),
    }
}
