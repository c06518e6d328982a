//! The version in all files that state it, and the compiler.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::process::Command;

/// Checks that what would be published is what is committed.
pub fn tree(workspace: &Workspace) -> Outcome {
    let mut git = Command::new("git");
    match command::output(git.args(["status", "--porcelain"]).current_dir(&workspace.root)) {
        Ok((true, text)) if text.is_empty() => Outcome::Passed("nothing is uncommitted".into()),
        Ok((true, text)) => Outcome::Failed(format!("{} files are uncommitted", text.lines().count())),
        Ok(_) => Outcome::Failed("`git status` failed".into()),
        Err(why) => Outcome::Failed(why),
    }
}

/// Checks that the files state this version, and that this compiler is the oldest that is promised.
pub fn check(workspace: &Workspace, version: &str) -> Outcome {
    if version.split('.').count() != 3 || !version.split('.').all(|part| part.parse::<u32>().is_ok()) {
        return Outcome::Failed(format!("`{version}` is no version, expected as 1.2.3"));
    }
    let said = [
        ("Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("Cargo.toml", format!("\nmozzi = {{ path = \"crates/mozzi\", version = \"{version}\" }}")),
        ("CITATION.cff", format!("\nversion: {version}\n")),
    ];
    for (file, text) in said {
        match std::fs::read_to_string(workspace.path(file)) {
            Ok(content) if content.contains(&text) => {}
            Ok(_) => return Outcome::Failed(format!("{file} does not say `{}`", text.trim())),
            Err(error) => return Outcome::Failed(format!("{file}: {error}")),
        }
    }
    let manifest = std::fs::read_to_string(workspace.path("Cargo.toml")).unwrap_or_default();
    let promised = manifest.split("rust-version = \"").nth(1).and_then(|rest| rest.split('"').next());
    match (promised, command::output(Command::new("rustc").arg("--version"))) {
        (Some(promised), Ok((true, found))) if found.starts_with(&format!("rustc {promised}.")) => {
            Outcome::Passed(format!("{version}; {} is the oldest promised", found.trim()))
        }
        (promised, found) => Outcome::Failed(format!("rust-version is {promised:?}, the compiler {found:?}")),
    }
}
