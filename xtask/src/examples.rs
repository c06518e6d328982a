//! The numbered examples: each `examples/NN_name.rs`, and its `.py` twin.

use crate::command;
use crate::oracles;
use crate::package;
use crate::report::Outcome;
use crate::workspace::{FEATURES, Workspace};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;

/// Python examples that take minutes: tests run a short version.
const SHORT: [&str; 1] = ["31_torch_policy.py"];

/// The Rust examples' programs, by name.
pub type Programs = BTreeMap<String, PathBuf>;

/// Those of the whole workspace, in the profile that `cargo test` has just built, so that nothing is built twice.
pub fn build(workspace: &Workspace, programs: &mut Programs) -> Outcome {
    let arguments = ["build", "--quiet", "--workspace", "--examples", "--profile", "test", "--message-format", "json"];
    let messages = match command::output(workspace.cargo(&arguments).args(FEATURES)) {
        Ok((true, messages)) => messages,
        Ok((false, _)) => return Outcome::Failed("cargo build --workspace --examples failed".into()),
        Err(why) => return Outcome::Failed(why),
    };
    programs.extend(messages.lines().filter_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        Some((message["target"]["name"].as_str()?.to_owned(), message["executable"].as_str()?.into()))
    }));
    Outcome::Passed(format!("{} programs", programs.len()))
}

pub enum Example {
    Rust(String),
    Python(PathBuf),
    /// The folder has no examples.
    None,
}

/// In the order of their numbers, each Rust example before its twin; never empty, so that the report has a line.
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

    /// In an empty folder under `target/`, to which it may write.
    pub fn run(&self, workspace: &Workspace, programs: &Programs) -> Outcome {
        let folder = match workspace.scratch(&self.name()) {
            Ok(folder) => folder,
            Err(why) => return Outcome::Failed(why),
        };
        match self {
            Self::None => Outcome::Skipped("there is nothing in examples/ yet".into()),
            Self::Rust(_) if !workspace.path("examples/Cargo.toml").exists() => {
                Outcome::Failed("there is no examples/Cargo.toml".into())
            }
            Self::Rust(name) => match programs.get(name) {
                Some(program) => {
                    let mut command = Command::new(program);
                    command.envs(oracles::robots(workspace).map(|robots| ("MOZZI_ROBOTS", robots)));
                    command::outcome(command.current_dir(&folder))
                }
                None => Outcome::Failed(format!("cargo build made no program of examples/{name}.rs")),
            },
            Self::Python(file) => {
                let mut python = package::python(workspace);
                let options = SHORT.iter().filter(|name| file.ends_with(name)).map(|_| "--short");
                command::outcome(python.arg(file).args(options).current_dir(folder))
            }
        }
    }
}
