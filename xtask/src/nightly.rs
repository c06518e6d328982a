//! Checks that take hours: long simulations, other processors, fuzzing with and without coverage guidance, accuracy at
//! many states, random robots. The log of a night is `target/nightly/DATE.md`; each step is written when it ends.

use crate::accuracy;
use crate::campaign;
use crate::command;
use crate::fuzz;
use crate::oracles;
use crate::other_targets;
use crate::report::{Outcome, Report};
use crate::venv;
use crate::workspace::Workspace;
use std::process::{Command, ExitCode};
use std::time::{SystemTime, UNIX_EPOCH};

/// The default time for each fuzz target, s; `--seconds` overrides it.
pub const SECONDS: u32 = 3600;
const FOLDER: &str = "target/nightly";
/// Initial inputs of a target in addition to its corpus.
const SEEDS: [(&str, &[&str]); 3] = [
    ("urdf", &["crates/mozzi-urdf/models", "crates/mozzi-urdf/tests/broken"]),
    ("mjcf", &["oracles", "crates/mozzi-urdf/tests/broken/mjcf"]),
    ("xacro", &["examples/xacro", "crates/mozzi-urdf/tests/xacro"]),
];

pub fn run(workspace: &Workspace, seconds: u32) -> ExitCode {
    let file = workspace.path(FOLDER).join(format!("{}.md", today()));
    let commit = workspace.git(&["rev-parse", "HEAD"]).unwrap_or_default();
    let head = format!("# {}\n\ncommit {}, {seconds} s for each fuzz target\n\n", today(), commit);
    let mut report = Report::with_log(file, &head);
    report.step("Python environment", || venv::prepare(workspace));
    report.step("reference numbers", || oracles::make(workspace));
    report.step("long simulations", || {
        let mut cargo = workspace.cargo(&["test", "--package", "mozzi-sim"]);
        command::outcome(cargo.args(["--", "--ignored", "--nocapture"]))
    });
    report.step("repairs of 200 faults, of none, and of published robots", || {
        let mut cargo = workspace.cargo(&["test", "--package", "mozzi-urdf", "--test", "all"]);
        cargo.envs(oracles::robots(workspace).map(|robots| ("MOZZI_ROBOTS", robots)));
        cargo.envs(oracles::folder(workspace).map(|oracles| ("MOZZI_ORACLES", oracles)));
        command::outcome(cargo.args(["--", "--ignored", "--nocapture", "repairs", "published"]))
    });
    report.step("accuracy at 1000 states", || {
        let page = workspace.path(FOLDER).join("accuracy.md");
        accuracy::run(workspace, &["--states", "1000", "--page", &page.to_string_lossy()])
    });
    report.step("random robots", || robots(workspace, seconds));
    report.step("AArch64", || other_targets::aarch64(workspace));
    report.step("AArch64, to the bit", || other_targets::aarch64_bits(workspace));
    report.step("AArch64, random programs", || other_targets::aarch64_programs(workspace, seconds));
    report.step("Windows and macOS", || other_targets::windows_and_macos(workspace));
    report.step("WebAssembly in node", || other_targets::node(workspace));
    report.step("xacro beside PyPI's", || xacro(workspace, seconds));
    report.step("fuzzing, plain", || fuzz::run(workspace, Some(seconds)));
    for target in targets(workspace) {
        report.step(&format!("fuzzing, guided by coverage: {target}"), || guided(workspace, &target, seconds));
    }
    report.finish()
}

/// The differential campaign for this time, with other robots each night: seeds begin with the date.
fn robots(workspace: &Workspace, seconds: u32) -> Outcome {
    let [page, state] = ["campaign.md", "campaign.json"].map(|name| workspace.path(FOLDER).join(name));
    let (page, state) = (page.to_string_lossy(), state.to_string_lossy());
    let (seed, seconds) = (format!("{}00000000", today().replace('-', "")), seconds.to_string());
    let robots = u32::MAX.to_string();
    let options = ["--seed", &seed, "--seconds", &seconds, "--robots", &robots, "--page", &page, "--state", &state];
    campaign::run(workspace, &options)
}

/// Random expressions, different ones each night.
fn xacro(workspace: &Workspace, seconds: u32) -> Outcome {
    if let Err(why) = command::run(workspace.cargo(&["build", "--release", "-p", "mozzi-xacro", "--example", "batch"]))
    {
        return Outcome::Failed(why);
    }
    let mut python = Command::new(venv::python(workspace));
    python.arg(workspace.path("crates/mozzi-xacro/tests/compare.py"));
    python.arg(workspace.target().join("release/examples/batch"));
    command::outcome(python.args(["--fuzz", &seconds.to_string(), "--seed", &today().replace('-', "")]))
}

/// The names in `fuzz/fuzz_targets`.
fn targets(workspace: &Workspace) -> Vec<String> {
    let files = std::fs::read_dir(workspace.path("fuzz/fuzz_targets")).into_iter().flatten().filter_map(Result::ok);
    let mut names: Vec<String> =
        files.filter_map(|file| Some(file.path().file_stem()?.to_string_lossy().into_owned())).collect();
    names.sort();
    names
}

fn guided(workspace: &Workspace, target: &str, seconds: u32) -> Outcome {
    if !command::exists(&mut workspace.cargo(&["fuzz"])) {
        return Outcome::Skipped("`cargo install cargo-fuzz` installs what it needs".into());
    }
    let corpus = format!("fuzz/corpus/{target}"); // new inputs are written to the first folder
    if let Err(why) = std::fs::create_dir_all(workspace.path(&corpus)) {
        return Outcome::Failed(format!("{corpus}: {why}"));
    }
    let seeds = SEEDS.iter().filter(|(name, _)| *name == target).flat_map(|(_, folders)| *folders);
    // the readers are safe Rust: panics are looked for, at several times the rate that a sanitizer leaves
    let mut cargo = workspace.cargo(&["fuzz", "run", "--sanitizer", "none", target, &corpus]);
    cargo.args(seeds).arg("--").arg(format!("-max_total_time={seconds}")).env("RUSTC_BOOTSTRAP", "1");
    command::outcome(cargo.args(["-rss_limit_mb=3000", "-timeout=20", "-print_final_stats=1"]))
}

/// The date in UTC, `2026-11-23`.
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    date(i64::try_from(seconds / 86_400).unwrap_or_default())
}

/// The date of a number of days since 1970. Years begin in March here, so that a leap day is the last day of a year.
fn date(days: i64) -> String {
    let days = days + 719_468; // since 1 March 0000
    let (era, day) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    format!("{:04}-{month:02}-{day:02}", year + era * 400 + i64::from(month <= 2))
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn days_are_dates() {
        for (days, expected) in [
            (0, "1970-01-01"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (20_780, "2026-11-23"),
            (47_540, "2100-02-28"),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
