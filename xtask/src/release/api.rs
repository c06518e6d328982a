//! The public items of each public crate, a line each, in docs/api: a change of the interface shows in a review.

use super::crates::PUBLIC;
use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const FOLDER: &str = "docs/api";

/// Libraries whose items are listed: the command line's interface is docs/command-line.md.
fn libraries() -> impl Iterator<Item = &'static str> {
    PUBLIC.into_iter().filter(|name| *name != "mozzi-cli")
}

fn file(name: &str) -> String {
    format!("{}.txt", name.replace('-', "_"))
}

/// Rewrites the lists.
pub fn write(workspace: &Workspace) -> Outcome {
    match list(workspace, &workspace.path(FOLDER)) {
        Ok(lines) => Outcome::Passed(format!("{lines} public items in {FOLDER}")),
        Err(why) => Outcome::Failed(why),
    }
}

/// Checks that the committed lists are current.
pub fn check(workspace: &Workspace) -> Outcome {
    let listed = workspace.scratch("api").and_then(|folder| list(workspace, &folder).map(|lines| (folder, lines)));
    let (folder, lines) = match listed {
        Ok(listed) => listed,
        Err(why) => return Outcome::Failed(why),
    };
    let read = |path: PathBuf| std::fs::read_to_string(path).unwrap_or_default();
    let outdated: Vec<String> = libraries()
        .map(file)
        .filter(|name| read(folder.join(name)) != read(workspace.path(FOLDER).join(name)))
        .map(|name| format!("{FOLDER}/{name}"))
        .collect();
    match outdated.is_empty() {
        true => Outcome::Passed(format!("{lines} public items")),
        false => Outcome::Failed(format!("outdated: {}; run `cargo xtask api`", outdated.join(", "))),
    }
}

/// Lists all items by rustdoc's JSON, which compilers of this version write only if they are told to be unstable.
fn list(workspace: &Workspace, folder: &Path) -> Result<usize, String> {
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
    let lines = |name: &str| std::fs::read_to_string(folder.join(file(name))).map(|text| text.lines().count());
    libraries().map(lines).sum::<Result<_, _>>().map_err(|error| format!("{}: {error}", folder.display()))
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
