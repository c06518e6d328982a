//! A sample, by a seed, of the faults that cargo-mutants puts into the kernels, one at a time, each shown to the tests.
//!
//! `.cargo/mutants.toml` lists the files. A fault in a crate is shown to the unit tests of that crate, and to the
//! conformance test of mozzi-engine, which computes every quantity twice. The results are in
//! `target/mutants/mutants.out`, a line of counts is added to docs/mutants.md.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use serde_json::Value;

const PAGE: &str = "docs/mutants.md";
const FOLDER: &str = "target/mutants";
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
    let (_, list) = command::output(workspace.cargo(&["mutants", "--list"]))?;
    let all = list.lines().count();
    let shards = (all / sample).max(1);
    let mut mutants = workspace.cargo(&["mutants", "--in-place", "--no-shuffle", "--sharding", "round-robin"]);
    mutants.args(["--shard", &format!("{}/{shards}", seed % shards), "--output", FOLDER, "--timeout", "300"]);
    // the crate's own tests, and those that compute every quantity in every way
    mutants.args([
        "--test-package",
        "mozzi,mozzi-engine,mozzi-sim",
        "--baseline",
        "run",
        "--",
        "--lib",
        "--test",
        "all",
    ]);
    let _ = command::run(mutants); // its exit code says that some were missed
    let file = workspace.path(FOLDER).join("mutants.out/outcomes.json");
    let text = workspace.read(&format!("{FOLDER}/mutants.out/outcomes.json"))?;
    let found: Value = serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))?;
    let number = |what: &str| found[what].as_u64().unwrap_or_default();
    let (caught, missed, unviable) = (number("caught") + number("timeout"), number("missed"), number("unviable"));
    let share = 100.0 * caught as f64 / (caught + missed).max(1) as f64;
    let commit = workspace.git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let line = format!("| {commit} | {seed} of {shards} | {caught} | {missed} | {unviable} | {share:.1} % |\n");
    std::fs::write(workspace.path(PAGE), workspace.read(PAGE)? + &line).map_err(|error| format!("{PAGE}: {error}"))?;
    Ok(Outcome::Passed(format!("{caught} noticed, {missed} not, {unviable} do not compile; {FOLDER}/mutants.out")))
}
