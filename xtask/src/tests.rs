//! `cargo test --workspace`, doc tests included, with the tests counted.

use crate::command;
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

impl Count {
    /// Records a failure before the tests could be counted.
    pub fn fail(&mut self) {
        self.failed = self.failed.max(1);
    }

    /// Add pytest's last line, such as `1 failed, 41 passed, 2 skipped in 3.10s`.
    pub fn add_pytest(&mut self, line: &str) {
        let Some((counts, time)) = line.trim_matches(['=', ' ']).rsplit_once(" in ") else { return };
        let seconds = time.split_whitespace().next().and_then(|time| time.strip_suffix('s'));
        if seconds.and_then(|seconds| seconds.parse::<f64>().ok()).is_none() {
            return;
        }
        for part in counts.split(',') {
            match part.trim().split_once(' ').and_then(|(n, word)| Some((n.parse::<usize>().ok()?, word))) {
                Some((n, "passed")) => self.passed += n,
                Some((n, "failed" | "error" | "errors")) => self.failed += n,
                Some((n, "skipped")) => self.ignored += n,
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

/// Run all tests, even if some fail.
pub fn run(workspace: &Workspace, count: &mut Count) -> Outcome {
    let mut cargo = workspace.cargo(&["test", "--workspace", "--no-fail-fast"]);
    cargo.args(FEATURES);
    give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    let python = venv::python(workspace);
    give(&mut cargo, "MOZZI_PYTHON", python.is_file().then_some(python));
    give(&mut cargo, "MOZZI_BROWSER", page::browser());
    run_counted(&mut cargo, count, Count::add)
}

/// Runs tests whose output reports how many there were.
pub fn run_counted(command: &mut Command, count: &mut Count, add: impl Fn(&mut Count, &str)) -> Outcome {
    let (program, mut here) = (command::shown(command), Count::default());
    println!("$ {program}");
    let outcome = match stream(command, |line| add(&mut here, line)) {
        Err(error) => Outcome::Failed(format!("`{program}` did not start: {error}")),
        Ok(true) => Outcome::Passed(format!("{here}, {} ignored", here.ignored)),
        Ok(false) => {
            here.fail(); // a program that did not build, or crashed, has no result line
            Outcome::Failed(here.to_string())
        }
    };
    count.passed += here.passed;
    count.failed += here.failed;
    count.ignored += here.ignored;
    outcome
}

/// Passes a path to the tests, if it exists.
pub fn give(cargo: &mut Command, variable: &str, path: Option<std::path::PathBuf>) {
    match path {
        Some(path) => {
            println!("{variable}={}", path.display());
            cargo.env(variable, path);
        }
        None => println!("{variable} is not set: nothing there; tests that need it skip themselves"),
    }
}

/// Prints its standard output and passes each line on; returns whether it succeeded.
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

    #[test]
    fn the_last_line_of_pytest_is_counted() {
        let mut count = Count::default();
        count.add_pytest("....F.. [100%]");
        count.add_pytest("FAILED crates/a.py::test_b - AssertionError: 3 passed in the wrong way");
        count.add_pytest("1 failed, 41 passed, 2 skipped, 1 error in 63.10s (0:01:03)");
        assert_eq!(count, Count { passed: 41, failed: 2, ignored: 2 });
    }
}
