//! Lines and regions that the tests of each library run, into docs/coverage.md; pages line by line in
//! `target/coverage/html`, what no test runs in `target/coverage/uncovered.txt`.
//!
//! rustc writes profiles for its own version of LLVM. `llvm-profdata` and `llvm-cov` of it are rustup's component
//! `llvm-tools`, or in the folder that `MOZZI_LLVM` names.

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::tests::give;
use crate::venv;
use crate::workspace::Workspace;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const PAGE: &str = "docs/coverage.md";
const FOLDER: &str = "target/coverage";
/// The libraries that are counted, by their tests; those of the command line and of Python run them, too, uncounted.
/// The tests of mozzi-identify fit logs: with counters they take longer than all others.
const PACKAGES: [&str; 6] = ["mozzi", "mozzi-engine", "mozzi-sim", "mozzi-motion", "mozzi-urdf", "mozzi-xacro"];

/// Lines and regions: how many there are, and how many ran.
#[derive(Default)]
struct Counts {
    lines: [u64; 2],
    regions: [u64; 2],
}

pub fn run(workspace: &Workspace) -> Outcome {
    match try_run(workspace) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_run(workspace: &Workspace) -> Result<Outcome, String> {
    let Some(tools) = tools(workspace) else {
        return Ok(Outcome::Skipped("`rustup component add llvm-tools`, or MOZZI_LLVM names llvm-cov's folder".into()));
    };
    let profiles = workspace.fresh_folder(&format!("{FOLDER}/profiles"))?;
    let programs = programs(workspace)?;
    // a test of mozzi-xacro runs it
    command::run(&mut instrumented(workspace, &["build", "--package", "mozzi-xacro", "--example", "batch"]))?;
    let mut cargo = tests(workspace);
    cargo.arg("--no-fail-fast").env("LLVM_PROFILE_FILE", profiles.join("%m-%p.profraw"));
    let failed = command::run(&mut cargo).err();
    let merged = workspace.path(FOLDER).join("tests.profdata");
    let mut merge = Command::new(tools.join("llvm-profdata"));
    merge.args(["merge", "-sparse", "-o"]).arg(&merged).arg(&profiles);
    command::run(merge)?;

    let cov = |format: &[&str]| {
        let mut cov = Command::new(tools.join("llvm-cov"));
        cov.args(format).arg("-ignore-filename-regex=(\\.cargo|rustc|/tests/|tests\\.rs|/oracles/)");
        cov.arg(format!("-instr-profile={}", merged.display()));
        for program in &programs {
            cov.arg("-object").arg(program);
        }
        cov
    };
    let (_, summary) = command::output(cov(&["export", "-summary-only"]))?;
    let summary: Value = serde_json::from_str(&summary).map_err(|error| format!("llvm-cov: {error}"))?;
    let counts = counts(workspace, &summary);
    std::fs::write(workspace.path(PAGE), page(&counts)).map_err(|error| format!("{PAGE}: {error}"))?;
    let (_, lines) = command::output(cov(&["export", "-format=lcov"]))?;
    let uncovered = uncovered(workspace, &lines);
    let list = workspace.path(FOLDER).join("uncovered.txt");
    std::fs::write(&list, &uncovered).map_err(|error| format!("{}: {error}", list.display()))?;
    let html = workspace.path(FOLDER).join("html");
    command::run(cov(&["show", "-format=html", &format!("-output-dir={}", html.display())]))?;
    let note = format!("{PAGE}, {FOLDER}/html; {} lines that no test runs", uncovered.lines().count());
    Ok(match failed {
        None => Outcome::Passed(note),
        Some(why) => Outcome::Failed(format!("{why}; {note}")),
    })
}

/// The folder of llvm-cov for this rustc.
fn tools(workspace: &Workspace) -> Option<PathBuf> {
    if let Some(folder) = std::env::var_os("MOZZI_LLVM") {
        return Some(folder.into());
    }
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    let rustc = rustc.args(["--print", "sysroot"]).current_dir(&workspace.root);
    let (_, sysroot) = command::output(rustc).ok()?;
    let targets = std::fs::read_dir(Path::new(sysroot.trim()).join("lib/rustlib")).ok()?;
    let bin = targets.filter_map(Result::ok).map(|target| target.path().join("bin"));
    bin.into_iter().find(|bin| bin.join("llvm-cov").is_file())
}

/// Cargo for instrumented programs, in a folder of its own.
fn instrumented(workspace: &Workspace, words: &[&str]) -> Command {
    let mut cargo = workspace.cargo(words);
    cargo.args(["--target-dir", "target/coverage/build"]);
    // counters are slow where nothing is inlined
    for package in ["mozzi", "nalgebra"] {
        for profile in ["dev", "test"] {
            cargo.args(["--config", &format!("profile.{profile}.package.{package}.opt-level=3")]);
        }
    }
    cargo.env("RUSTFLAGS", "-Cinstrument-coverage").env("CARGO_INCREMENTAL", "0");
    cargo
}

/// `cargo test` of the libraries.
fn tests(workspace: &Workspace) -> Command {
    let mut cargo = instrumented(workspace, &["test", "--lib", "--tests"]);
    for package in PACKAGES {
        cargo.args(["--package", package]);
    }
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    let python = venv::python(workspace);
    give(&mut cargo, "MOZZI_PYTHON", python.is_file().then_some(python));
    cargo
}

/// The programs of the tests.
fn programs(workspace: &Workspace) -> Result<Vec<PathBuf>, String> {
    let mut cargo = tests(workspace);
    // build scripts and macros are instrumented, too
    cargo.env("LLVM_PROFILE_FILE", workspace.path(FOLDER).join("build/%m-%p.profraw"));
    let (succeeded, messages) = command::output(cargo.args(["--no-run", "--message-format", "json"]))?;
    if !succeeded {
        return Err("the tests do not build".into());
    }
    let executable = |line: &str| {
        let message: Value = serde_json::from_str(line).ok()?;
        Some(PathBuf::from(message["executable"].as_str()?))
    };
    Ok(messages.lines().filter_map(executable).collect())
}

/// The counts of each crate.
fn counts(workspace: &Workspace, summary: &Value) -> BTreeMap<String, Counts> {
    let mut counts: BTreeMap<String, Counts> = BTreeMap::new();
    for file in summary["data"][0]["files"].as_array().into_iter().flatten() {
        let Some(name) = file["filename"].as_str().and_then(|name| source(workspace, name)) else { continue };
        if !is_counted(&name) {
            continue;
        }
        let entry = counts.entry(package(&name).to_owned()).or_default();
        let number = |kind: &str, what: &str| file["summary"][kind][what].as_u64().unwrap_or_default();
        for (k, what) in ["covered", "count"].into_iter().enumerate() {
            entry.lines[k] += number("lines", what);
            entry.regions[k] += number("regions", what);
        }
    }
    counts
}

/// A source file's path in the repository.
fn source(workspace: &Workspace, file: &str) -> Option<String> {
    let root = workspace.root.canonicalize().ok()?;
    let path = Path::new(file).strip_prefix(&root).ok()?;
    let name = path.to_string_lossy().replace('\\', "/");
    (name.starts_with("crates/") && name.contains("/src/")).then_some(name)
}

fn package(name: &str) -> &str {
    name.split('/').nth(1).unwrap_or_default()
}

fn is_counted(name: &str) -> bool {
    PACKAGES.contains(&package(name))
}

fn page(counts: &BTreeMap<String, Counts>) -> String {
    let share = |[covered, all]: [u64; 2]| 100.0 * covered as f64 / (all as f64).max(1.0);
    let mut text =
        "# Coverage\n\nWhat the tests of the libraries run, unit and integration tests without those of \
                    identification, the command line, Python and C.\n`cargo xtask coverage` writes this page, pages line by line into \
                    `target/coverage/html`, and a list of the lines that no\ntest runs into \
                    `target/coverage/uncovered.txt`. Tests themselves are not counted.\n\n\
                    | crate | lines | covered | regions | covered |\n|---|---|---|---|---|\n"
            .to_owned();
    let mut all = Counts::default();
    for (name, of) in counts {
        let _ = writeln!(
            text,
            "| {name} | {} | {:.1} % | {} | {:.1} % |",
            of.lines[1],
            share(of.lines),
            of.regions[1],
            share(of.regions)
        );
        for k in 0..2 {
            all.lines[k] += of.lines[k];
            all.regions[k] += of.regions[k];
        }
    }
    let _ = writeln!(
        text,
        "| together | {} | {:.1} % | {} | {:.1} % |",
        all.lines[1],
        share(all.lines),
        all.regions[1],
        share(all.regions)
    );
    text
}

/// `FILE:LINE: text` of each line that ran zero times, from a report in lcov's format.
fn uncovered(workspace: &Workspace, lcov: &str) -> String {
    let (mut text, mut file, mut lines) = (String::new(), None, Vec::new());
    for record in lcov.lines() {
        if let Some(path) = record.strip_prefix("SF:") {
            file = source(workspace, path).filter(|name| is_counted(name));
            let content = file.as_ref().and_then(|name| std::fs::read_to_string(workspace.path(name)).ok());
            lines = content.unwrap_or_default().lines().map(str::to_owned).collect();
        } else if let (Some(name), Some((line, "0"))) =
            (&file, record.strip_prefix("DA:").and_then(|rest| rest.split_once(',')))
        {
            let number: usize = line.parse().unwrap_or_default();
            let code = lines.get(number.wrapping_sub(1)).map_or("", |line| line.trim());
            let _ = writeln!(text, "{name}:{line}: {code}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{counts, uncovered};
    use crate::workspace::Workspace;

    #[test]
    fn lines_that_never_ran_are_listed() {
        let workspace = Workspace::find();
        let root = workspace.root.canonicalize().expect("a folder");
        let file = root.join("crates/mozzi/src/lib.rs");
        let lcov = format!("SF:{}\nDA:1,0\nDA:2,7\nend_of_record\n", file.display());
        let found = uncovered(&workspace, &lcov);
        assert!(found.starts_with("crates/mozzi/src/lib.rs:1: ") && found.lines().count() == 1, "{found}");
    }

    #[test]
    fn counts_are_summed_by_crate() {
        let workspace = Workspace::find();
        let root = workspace.root.canonicalize().expect("a folder");
        let file = |name: &str| {
            let name = root.join(name);
            let summary = r#"{"lines": {"count": 10, "covered": 9}, "regions": {"count": 4, "covered": 2}}"#;
            format!(r#"{{"filename": "{}", "summary": {summary}}}"#, name.display())
        };
        let files = [file("crates/mozzi/src/lib.rs"), file("crates/mozzi/src/fast.rs"), file("xtask/src/main.rs")];
        let summary = format!(r#"{{"data": [{{"files": [{}]}}]}}"#, files.join(","));
        let counts = counts(&workspace, &serde_json::from_str(&summary).expect("JSON"));
        assert_eq!((counts.len(), counts["mozzi"].lines, counts["mozzi"].regions), (1, [18, 20], [4, 8]));
    }
}
