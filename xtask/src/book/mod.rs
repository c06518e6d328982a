//! The documentation book: `xtask/book` builds it from `book/`, `docs/` and the sources; [`run`] executes its code.

mod blocks;
mod expected;
mod run;
mod search;

pub use run::code;
pub use search::check as search;

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::PathBuf;

/// The libraries whose documentation the book contains.
const DOCUMENTED: [&str; 8] = [
    "mozzi",
    "mozzi-sim",
    "mozzi-urdf",
    "mozzi-motion",
    "mozzi-engine",
    "mozzi-symbolic",
    "mozzi-identify",
    "mozzi-report",
];

/// Where the book is written.
const FOLDER: &str = "target/book";

/// The program that a user would run, built if it is not current.
fn mozzi(workspace: &Workspace) -> Result<PathBuf, String> {
    command::run(workspace.cargo(&["build", "--release", "--quiet", "--package", "mozzi-cli"]))?;
    Ok(workspace.target().join("release").join(format!("mozzi{}", std::env::consts::EXE_SUFFIX)))
}

/// Builds the book and checks its links; with the documentation of the Rust libraries in it, if `with_rustdoc`.
pub fn build(workspace: &Workspace, with_rustdoc: bool) -> Outcome {
    try_build(workspace, with_rustdoc).map_or_else(Outcome::Failed, Outcome::Passed)
}

fn try_build(workspace: &Workspace, with_rustdoc: bool) -> Result<String, String> {
    let mozzi = mozzi(workspace)?;
    let mut builder = builder(workspace, "run");
    builder.arg("--").args([&workspace.root, &workspace.path(FOLDER), &mozzi]);
    if with_rustdoc {
        let target = workspace.path("target/book_rustdoc");
        let packages = DOCUMENTED.iter().flat_map(|name| ["--package", name]);
        let mut doc = workspace.cargo(&[
            "doc",
            "--quiet",
            "--no-deps",
            "--lib",
            "--features",
            "mozzi-urdf/pretty",
            "--target-dir",
        ]);
        command::run(doc.arg(&target).args(packages))?;
        builder.arg(target.join("doc"));
    }
    let (succeeded, summary) = command::output(builder)?;
    print!("{summary}");
    if succeeded { Ok(summary.trim().to_owned()) } else { Err("the book has problems: see above".into()) }
}

/// The tests of the builder itself.
pub fn test_builder(workspace: &Workspace) -> Outcome {
    command::outcome(builder(workspace, "test"))
}

/// A cargo command on the builder, which is a workspace of its own: nothing else compiles mdBook.
fn builder(workspace: &Workspace, command: &str) -> std::process::Command {
    let mut cargo = workspace.cargo(&[command, "--quiet", "--locked", "--manifest-path"]);
    cargo.arg(workspace.path("xtask/book/Cargo.toml"));
    cargo.arg("--target-dir").arg(workspace.path("target/book_builder"));
    cargo
}
