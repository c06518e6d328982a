//! `cargo test --workspace`, doc tests included, with the tests counted.

use crate::oracles;
use crate::page;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::{FEATURES, Workspace};
use std::fmt;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// The sum over every test program of the workspace.
#[derive(Default, Debug, PartialEq)]
pub struct Count {
    passed: usize,
    failed: usize,
    ignored: usize,
}

impl Count {
    /// Add a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`; other lines say nothing.
    fn add(&mut self, line: &str) {
        let Some(result) = line.trim().strip_prefix("test result: ") else { return };
        let (_, counts) = result.split_once(". ").unwrap_or_default();
        for part in counts.split(';') {
            match part.trim().split_once(' ').and_then(|(n, word)| Some((n.parse::<usize>().ok()?, word))) {
                Some((n, "passed")) => self.passed += n,
                Some((n, "failed")) => self.failed += n,
                Some((n, "ignored")) => self.ignored += n,
                _ => {}
            }
        }
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

/// Run every test, whichever fails before it.
pub fn run(workspace: &Workspace, count: &mut Count) -> Outcome {
    let mut cargo = workspace.cargo(&["test", "--workspace", "--no-fail-fast"]);
    cargo.args(FEATURES);
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    let python = venv::python(workspace);
    give(&mut cargo, "MOZZI_PYTHON", python.is_file().then_some(python));
    give(&mut cargo, "MOZZI_BROWSER", page::browser());
    println!("$ cargo test --workspace --no-fail-fast {}", FEATURES.join(" "));
    match stream(&mut cargo, |line| count.add(line)) {
        Err(error) => Outcome::Failed(format!("cargo test did not run: {error}")),
        Ok(true) => Outcome::Passed(format!("{count}, {} ignored", count.ignored)),
        Ok(false) => {
            // A program that did not build, or died, has no line of results of its own.
            count.failed = count.failed.max(1);
            Outcome::Failed(count.to_string())
        }
    }
}

/// Names a path to the tests, where it is there.
pub fn give(cargo: &mut Command, variable: &str, path: Option<std::path::PathBuf>) {
    match path {
        Some(path) => {
            println!("{variable}={}", path.display());
            cargo.env(variable, path);
        }
        None => println!("{variable} is not set: nothing there; tests that need it skip themselves"),
    }
}

/// Show its standard output and hand each line on; whether it succeeded.
fn stream(command: &mut Command, mut each: impl FnMut(&str)) -> std::io::Result<bool> {
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn()?;
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n') {
            let line = line?;
            let line = String::from_utf8_lossy(&line);
            println!("{line}");
            each(&line);
        }
    }
    Ok(child.wait()?.success())
}

#[cfg(test)]
mod unit {
    use super::Count;

    #[test]
    fn lines_of_results_are_summed() {
        let mut count = Count::default();
        count.add("test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s");
        count.add("test a::b ... ok");
        count.add("test result: FAILED. 2 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.5s");
        assert_eq!(count, Count { passed: 5, failed: 1, ignored: 1 });
        assert_eq!(count.to_string(), "5 passed, 1 failed");
    }
}
