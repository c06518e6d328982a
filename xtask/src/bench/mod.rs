//! The benchmarks, a separate package: mozzi compared with its peers.

mod contacts;
mod options;
mod peers;
mod python;
mod workshop;

pub use contacts::run as contacts;
pub use options::Options;
pub use python::run as python;

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;
use peers::PEERS;
use workshop::Workshop;

/// The folder of the tables of a full run; a partial run writes to `target/bench`.
const RESULTS: &str = "benches";

pub fn run(workspace: &Workspace, options: &Options) -> Outcome {
    match compare(workspace, options) {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

fn compare(workspace: &Workspace, options: &Options) -> Result<String, String> {
    if options.install {
        workshop::install()?;
    }
    if let Outcome::Failed(why) = venv::prepare(workspace) {
        return Err(why);
    }
    let workshop = Workshop::new(workspace)?;
    let models = oracles::robots(workspace).ok_or("the robots of example-robot-data are not installed")?;
    command::run(workspace.cargo(&["build", "--release", "-p", "mozzi-benches", "--bin", "compare"]))?;
    let compare = |arguments: &[&str]| {
        let mut cargo =
            workspace.cargo(&["run", "--release", "--quiet", "-p", "mozzi-benches", "--bin", "compare", "--"]);
        cargo.args(arguments).arg("--models").arg(&models);
        cargo
    };
    command::run(compare(&["--describe", &workshop.fresh_robots()?]))?;

    let folder = if options.is_whole() { RESULTS } else { "target/bench" };
    let mut run = compare(&["--write", folder]);
    let mut missing = Vec::new();
    for peer in PEERS.iter().filter(|peer| options.wants(peer)) {
        match (peer.build)(&workshop) {
            Ok(library) => run.arg("--peer").arg(format!("{}={}", peer.name, library.display())),
            Err(why) => {
                println!("{}: missing, {why}", peer.name);
                missing.push(peer.name);
                run.arg("--missing").arg(format!("{}={why}", peer.name))
            }
        };
    }
    for (word, value) in [("--robots", &options.robots), ("--seconds", &options.seconds)] {
        run.args(value.iter().flat_map(|value| [word, value]));
    }
    command::run(run)?;
    let note = if missing.is_empty() { String::new() } else { format!("; missing: {}", missing.join(", ")) };
    Ok(format!("{folder}/RESULTS.md and results.svg are written{note}"))
}
