//! The numbered examples: each `examples/NN_name.rs`, and its `.py` twin.

use crate::command;
use crate::oracles;
use crate::package;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::PathBuf;

pub enum Example {
    Rust(String),
    Python(PathBuf),
    /// The folder has none.
    None,
}

/// In the order of their numbers, the Rust one before its twin; never empty, so that the report has a line.
pub fn list(workspace: &Workspace) -> Vec<Example> {
    let entries = std::fs::read_dir(workspace.path("examples"));
    let mut files: Vec<_> = entries.into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path()).collect();
    files.sort_by_key(|path| (path.with_extension(""), path.extension().is_some_and(|ending| ending == "py")));
    let found: Vec<_> = files.into_iter().filter_map(Example::of).collect();
    if found.is_empty() { vec![Example::None] } else { found }
}

impl Example {
    fn of(file: PathBuf) -> Option<Self> {
        match file.extension()?.to_str()? {
            "rs" => Some(Self::Rust(file.file_stem()?.to_str()?.to_owned())),
            "py" => Some(Self::Python(file)),
            _ => None,
        }
    }

    pub fn name(&self) -> String {
        match self {
            Self::Rust(name) => format!("{name}.rs"),
            Self::Python(file) => file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Self::None => "(all)".into(),
        }
    }

    /// In an empty folder under `target/`, where it may write.
    pub fn run(&self, workspace: &Workspace) -> Outcome {
        let folder = match workspace.scratch(&self.name()) {
            Ok(folder) => folder,
            Err(why) => return Outcome::Failed(why),
        };
        match self {
            Self::None => Outcome::Skipped("there is nothing in examples/ yet".into()),
            Self::Rust(_) if !workspace.path("examples/Cargo.toml").exists() => {
                Outcome::Failed("there is no examples/Cargo.toml".into())
            }
            Self::Rust(name) => {
                // The profile in which `cargo test` has just built it.
                let arguments = ["--quiet", "--profile", "test", "-p", "mozzi-examples", "--example", name];
                let mut cargo = workspace.cargo_run_in(&folder, &arguments);
                if let Some(robots) = oracles::robots(workspace) {
                    cargo.env("MOZZI_ROBOTS", robots);
                }
                command::outcome(cargo)
            }
            Self::Python(file) => command::outcome(package::python(workspace).arg(file).current_dir(folder)),
        }
    }
}
