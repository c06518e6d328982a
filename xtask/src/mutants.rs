//! A sample, by a seed, of the faults that cargo-mutants puts into the kernels, one at a time, each shown to the tests.
//!
//! `.cargo/mutants.toml` lists the files. A fault in a crate is shown to the unit tests of that crate, and, if they
//! miss it, to all tests of [another](SECOND). What they miss, too, is in `target/mutants/CRATE`; a line of counts is
//! added to docs/mutants.md.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use serde_json::Value;

const PAGE: &str = "docs/mutants.md";
const FOLDER: &str = "target/mutants";
/// Crates, and whose tests see a fault that a crate's own unit tests miss: mozzi-engine's compute every quantity twice.
const SECOND: [(&str, &str); 3] =
    [("mozzi", "mozzi-engine"), ("mozzi-engine", "mozzi-engine"), ("mozzi-sim", "mozzi-sim")];
/// Faults in a sample, unless `--sample` is given.
pub const SAMPLE: usize = 60;

pub fn run(workspace: &Workspace, sample: usize, seed: usize) -> Outcome {
    match try_run(workspace, sample.max(1), seed) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_run(workspace: &Workspace, sample: usize, seed: usize) -> Result<Outcome, String> {
    if !command::exists(&mut workspace.cargo(&["mutants"])) {
        return Ok(Outcome::Skipped("`cargo install cargo-mutants` installs what it needs".into()));
    }
    let (_, list) = command::output(workspace.cargo(&["mutants", "--workspace", "--list"]))?;
    let all = list.lines().count();
    let shards = (all / sample).max(1);
    // first the crate's own tests, in seconds
    let mut own =
        workspace.cargo(&["mutants", "--workspace", "--in-place", "--no-shuffle", "--sharding", "round-robin"]);
    own.args(["--shard", &format!("{}/{shards}", seed % shards), "--output", FOLDER, "--timeout", "300"]);
    own.args(["--baseline", "run", "--", "--lib"]);
    let _ = command::run(own); // its exit code says that some were missed
    let [mut caught, mut missed, unviable] = counts(workspace, FOLDER)?;
    let names = workspace.read(&format!("{FOLDER}/mutants.out/missed.txt"))?;
    for (of, shown_to) in SECOND {
        let names: Vec<&str> = names.lines().filter(|name| name.starts_with(&format!("crates/{of}/"))).collect();
        if names.is_empty() {
            continue;
        }
        let folder = format!("{FOLDER}/{of}");
        let mut others = workspace.cargo(&["mutants", "--package", of, "--in-place", "--output", &folder]);
        for name in &names {
            others.args(["--re", &format!("^{}$", escaped(name))]);
        }
        others.args(["--timeout", "600", "--test-package", shown_to, "--baseline", "skip", "--", "--lib", "--tests"]);
        let _ = command::run(others);
        let still = workspace.read(&format!("{folder}/mutants.out/missed.txt"))?;
        let noticed = names.iter().filter(|name| still.lines().all(|line| line != **name)).count() as u64;
        (caught, missed) = (caught + noticed, missed - noticed);
    }
    let share = 100.0 * caught as f64 / (caught + missed).max(1) as f64;
    let commit = workspace.git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let line = format!("| {commit} | {seed} of {shards} | {caught} | {missed} | {unviable} | {share:.1} % |\n");
    std::fs::write(workspace.path(PAGE), workspace.read(PAGE)? + &line).map_err(|error| format!("{PAGE}: {error}"))?;
    Ok(Outcome::Passed(format!("{caught} noticed, {missed} not, {unviable} do not compile; {FOLDER}")))
}

/// How many faults were noticed, not noticed, and do not compile.
fn counts(workspace: &Workspace, folder: &str) -> Result<[u64; 3], String> {
    let file = format!("{folder}/mutants.out/outcomes.json");
    let found: Value = serde_json::from_str(&workspace.read(&file)?).map_err(|error| format!("{file}: {error}"))?;
    let number = |what: &str| found[what].as_u64().unwrap_or_default();
    Ok([number("caught") + number("timeout"), number("missed"), number("unviable")])
}

/// A regular expression that matches a text.
fn escaped(text: &str) -> String {
    let special = |c: char| r"\.+*?()|[]{}^$".contains(c);
    text.chars().flat_map(|c| special(c).then_some('\\').into_iter().chain([c])).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_of_faults_are_no_patterns() {
        let found = super::escaped("a/b.rs:38:33: replace + with * in Model<f64>::assemble");
        assert_eq!(found, r"a/b\.rs:38:33: replace \+ with \* in Model<f64>::assemble");
    }
}
