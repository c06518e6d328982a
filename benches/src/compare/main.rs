//! mozzi beside Pinocchio: the same robots, the same states, one process, one clock, one core, in turn.
//!
//! `compare [--peer LIBRARY] [--robots FOLDER] [--seconds S] [--write FILE]`; `cargo xtask bench` builds the peer and calls it.

mod kernel;
mod machine;
mod peer;
mod report;

use kernel::{KERNELS, Kernel};
use mozzi::Model;
use mozzi::native::Workspace;
use mozzi_benches::{States, robots};
use peer::Peer;
use std::ffi::OsString;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Further apart than this, over the largest entry, two libraries do not compute the same.
const LARGEST_DIFFERENCE: f64 = 1e-9;

/// Something to time.
struct Contender<'a> {
    kernel: &'static Kernel,
    /// How mozzi or Pinocchio computes it.
    path: &'static str,
    is_peer: bool,
    /// Over all states.
    run: Box<dyn FnMut() + 'a>,
    /// Nanoseconds for one evaluation, one entry a round.
    times: Vec<f64>,
}

#[derive(Default)]
struct Arguments {
    peer: Option<OsString>,
    robots: Option<OsString>,
    write: Option<OsString>,
    seconds: Option<f64>,
}

fn main() -> ExitCode {
    let result = arguments().and_then(|arguments| compare(&arguments));
    result.map_or_else(
        |why| {
            eprintln!("{why}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}

fn arguments() -> Result<Arguments, String> {
    let (mut arguments, mut words) = (Arguments::default(), std::env::args_os().skip(1));
    while let Some(word) = words.next() {
        let value =
            words.next().ok_or("usage: compare [--peer LIBRARY] [--robots FOLDER] [--seconds S] [--write FILE]")?;
        match word.to_str() {
            Some("--peer") => arguments.peer = Some(value),
            Some("--robots") => arguments.robots = Some(value),
            Some("--write") => arguments.write = Some(value),
            Some("--seconds") => arguments.seconds = value.to_str().and_then(|text| text.parse().ok()),
            _ => return Err(format!("{}: unknown", word.display())),
        }
    }
    Ok(arguments)
}

fn compare(arguments: &Arguments) -> Result<(), String> {
    machine::stay_on_one_processor();
    let peer = match &arguments.peer {
        Some(path) => Some(Peer::load(path).map_err(|error| error.to_string())?),
        None => None,
    };
    let time = Duration::from_secs_f64(arguments.seconds.unwrap_or(20.0));
    let mut tables = Vec::new();
    let legged = match &arguments.robots {
        Some(folder) => Some(robots::legged(folder.as_ref())?),
        None => None,
    };
    for (name, model) in robots::all().into_iter().chain(legged.into_iter().flatten()) {
        tables.push(robot(name, &model, peer.as_ref(), time)?);
    }
    let text = report::text(&tables, peer.as_ref());
    println!("{text}");
    match &arguments.write {
        Some(path) => std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display())),
        None => Ok(()),
    }
}

/// All kernels on one robot: first that the values agree, then the times.
fn robot(name: &str, model: &Model, peer: Option<&Peer>, time: Duration) -> Result<report::Table, String> {
    let states = States::new(model);
    let theirs = peer.map(|peer| peer.robot(model, &states));
    let mut differences = Vec::new();
    for kernel in &KERNELS {
        let difference = theirs.as_ref().map_or(0.0, |theirs| largest_difference(kernel, model, &states, theirs));
        if !(difference <= LARGEST_DIFFERENCE) {
            return Err(format!("{name}: {} differs from Pinocchio's by {difference:.1e}", kernel.name));
        }
        differences.push(difference);
    }

    let mut contenders = contenders(model, &states, theirs.as_ref());
    let start = Instant::now();
    while start.elapsed() < time || contenders[0].times.len() < 20 {
        for contender in &mut contenders {
            (contender.run)(); // what ran before leaves its own caches, branch history and, without AVX, half the unit asleep
            let start = Instant::now();
            (contender.run)();
            contender.times.push(start.elapsed().as_secs_f64() * 1e9 / States::COUNT as f64);
        }
    }
    Ok(report::Table::new(name, &contenders, &differences))
}

/// The largest difference of a kernel from any of Pinocchio's algorithms at any state.
fn largest_difference(kernel: &Kernel, model: &Model, states: &States, theirs: &peer::Robot) -> f64 {
    let (mut workspace, mut out) = (Workspace::new(model), vec![0.0; kernel.length(model)]);
    let mut worst = 0.0_f64;
    for (k, state) in states.iter().enumerate() {
        (kernel.run)(model, state, &model.environment(), &mut workspace, &mut out);
        for &algorithm in kernel.peer {
            let difference = kernel.difference(model, &out, &theirs.result(algorithm, k, out.len()));
            if difference.is_nan() {
                return difference;
            }
            worst = worst.max(difference);
        }
    }
    worst
}

/// Every way to compute every kernel.
fn contenders<'a>(model: &'a Model, states: &'a States, theirs: Option<&'a peer::Robot>) -> Vec<Contender<'a>> {
    let (environment, mut list) = (model.environment(), Vec::new());
    for kernel in &KERNELS {
        for mut workspace in [Workspace::new(model), Workspace::portable(model)] {
            let (path, mut out) = (workspace.instruction_set(), vec![0.0; kernel.length(model)]);
            let run = Box::new(move || {
                for state in states.iter() {
                    (kernel.run)(model, black_box(state), &environment, &mut workspace, &mut out);
                    black_box(&mut out);
                }
            });
            list.push(Contender { kernel, path, is_peer: false, run, times: Vec::new() });
        }
        for (&algorithm, theirs) in kernel.peer.iter().flat_map(|algorithm| theirs.map(|theirs| (algorithm, theirs))) {
            let run = Box::new(theirs.runner(algorithm));
            list.push(Contender { kernel, path: algorithm.name(), is_peer: true, run, times: Vec::new() });
        }
    }
    list
}
