//! A sample, by a seed, of the faults that `xtask/mutants` puts into the sources, each shown to the tests.
//!
//! Those that are missed are in `target/mutants/missed.md`; a line of counts is added to docs/mutants.md.

use crate::report::Outcome;
use crate::workspace::Workspace;
use crate::{command, oracles, tests};

const PAGE: &str = "docs/mutants.md";
const FOLDER: &str = "target/mutants";
/// Faults in a sample, unless `--sample` is given.
pub const SAMPLE: usize = 200;

pub fn run(workspace: &Workspace, sample: usize, seed: usize) -> Outcome {
    match try_run(workspace, sample.max(1), seed) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_run(workspace: &Workspace, sample: usize, seed: usize) -> Result<Outcome, String> {
    let mut cargo = workspace.cargo(&["run", "--quiet", "--locked", "--manifest-path", "xtask/mutants/Cargo.toml"]);
    cargo.arg("--target-dir").arg(workspace.path("target/mutants/build")).arg("--");
    cargo.arg(workspace.path(FOLDER)).args([sample.to_string(), seed.to_string()]);
    tests::give(&mut cargo, "MOZZI_ORACLES", oracles::folder(workspace));
    tests::give(&mut cargo, "MOZZI_ROBOTS", oracles::robots(workspace));
    let (succeeded, counts) = command::output(cargo)?;
    let numbers: Vec<f64> = counts.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let (true, &[noticed, missed]) = (succeeded, &numbers[..]) else {
        return Err("the sample was not shown to its end: see above".into());
    };
    let share = 100.0 * noticed / (noticed + missed).max(1.0);
    let commit = workspace.git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let line = format!("| {commit} | {seed} | {noticed} | {missed} | {share:.1} % |\n");
    std::fs::write(workspace.path(PAGE), workspace.read(PAGE)? + &line).map_err(|error| format!("{PAGE}: {error}"))?;
    Ok(Outcome::Passed(format!("{}; {FOLDER}/missed.md", counts.trim())))
}
