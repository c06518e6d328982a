//! The public items of each public crate, a line each, and how the interface differs from the last published version.

use super::crates::PUBLIC;
use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::Path;
use std::process::Command;

const FOLDER: &str = "target/api/items";

/// Libraries whose items are listed: the command line's interface is docs/command-line.md.
fn libraries() -> impl Iterator<Item = &'static str> {
    PUBLIC.into_iter().filter(|name| *name != "mozzi-cli")
}

fn file(name: &str) -> String {
    format!("{}.txt", name.replace('-', "_"))
}

/// Writes the lists.
pub fn write(workspace: &Workspace) -> Outcome {
    match list(workspace, &workspace.path(FOLDER)) {
        Ok(counts) => {
            let all: usize = counts.iter().map(|(_, lines)| lines).sum();
            let each = counts.iter().map(|(name, lines)| format!("{name} {lines}")).collect::<Vec<_>>().join(", ");
            Outcome::Passed(format!("{all} public items in {FOLDER}: {each}"))
        }
        Err(why) => Outcome::Failed(why),
    }
}

/// Lists all items from rustdoc's JSON, which stable compilers write only with RUSTC_BOOTSTRAP=1.
fn list(workspace: &Workspace, folder: &Path) -> Result<Vec<(&'static str, usize)>, String> {
    let target = workspace.path("target/api");
    let mut files = Vec::new();
    for name in libraries() {
        let mut cargo =
            workspace.cargo(&["rustdoc", "--quiet", "--package", name, "--lib", "--all-features", "--target-dir"]);
        cargo.arg(&target).args(["--", "-Zunstable-options", "--output-format", "json"]);
        command::run(cargo.env("RUSTC_BOOTSTRAP", "1"))?;
        files.push(target.join("doc").join(file(name)).with_extension("json"));
    }
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut cargo = workspace.cargo(&["run", "--quiet", "--locked", "--manifest-path"]);
    cargo.arg(workspace.path("xtask/api_list/Cargo.toml")).arg("--target-dir").arg(&target);
    command::run(cargo.arg("--").args(files).arg(folder))?;
    let lines = |name| Ok((name, std::fs::read_to_string(folder.join(file(name)))?.lines().count()));
    libraries()
        .map(lines)
        .collect::<Result<_, _>>()
        .map_err(|error: std::io::Error| format!("{}: {error}", folder.display()))
}

/// Compares with the last published version by `cargo semver-checks`.
pub fn compare(workspace: &Workspace) -> Outcome {
    let mut git = Command::new("git");
    let tags = command::output(git.args(["tag", "--list", "v*", "--sort=-v:refname"]).current_dir(&workspace.root));
    let Ok((true, tags)) = tags else { return Outcome::Failed("`git tag` failed".into()) };
    let Some(tag) = tags.lines().next() else { return Outcome::Skipped("no version is tagged yet".into()) };
    if !command::exists(Command::new("cargo").arg("semver-checks")) {
        return Outcome::Failed(format!("to compare with {tag}: cargo install cargo-semver-checks --locked"));
    }
    let mut cargo = workspace.cargo(&["semver-checks", "--baseline-rev", tag]);
    libraries().for_each(|name| {
        cargo.args(["--package", name]);
    });
    command::outcome(cargo)
}
