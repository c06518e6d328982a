//! `mozzi bench`: timings on this machine, for one state and for many.

mod page;
mod runs;
mod timing;

use super::assemble::needs_constraints;
use crate::failure::{self, Failure, Result};
use crate::interrupt;
use crate::missing;
use crate::progress::Progress;
use crate::quantity::{hyphenated, quantity};
use crate::robot::{RobotArguments, end_effector};
use crate::workload;
use clap::Args;
use mozzi::Model;
use mozzi::quantities::{Declaration, LIST, Of, Query, Uses};
use mozzi_engine::Batch;
use runs::{Data, Run, Subject};
use std::time::Instant;
use timing::{Report, Timing};

/// Relative to the largest entry: a larger difference between one state and many cannot be rounding.
const ROUNDING: f64 = 1e-6;

/// States in a batch, and the numbers of its results, by default.
const USUAL_STATES: u32 = 16384;
const USUAL_NUMBERS: usize = 32_000_000;
/// The numbers of a batch's results: with copies for each way, some GB.
const MOST_NUMBERS: usize = 128_000_000;

#[derive(Args, Debug)]
pub struct BenchArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// States in a batch [default: 16384, fewer if results take more than 256 MB]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    states: Option<u32>,
    /// Threads of the second table [default: one per core]
    #[arg(long, value_name = "K")]
    threads: Option<usize>,
    /// Number of timed rounds; quantities alternate within a round
    #[arg(long, value_name = "R", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Only this quantity; may be repeated [default: seven that are often used]
    #[arg(long, value_name = "NAME", value_parser = quantity(), value_delimiter = ',')]
    quantity: Vec<Query<'static>>,
    /// Time all quantities of positions, velocities and one further vector, and print engines and differences
    #[arg(long)]
    all: bool,
}

/// The quantities of the summary.
const OFTEN_USED: [&str; 7] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "bias_forces",
    "forward_kinematics",
    "body_jacobian",
    "inverse_dynamics_derivatives",
];

pub fn run(arguments: &BenchArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    if model.n() == 0 {
        return Err(Failure::wrong(format!("`{}` has no joint that moves: nothing to time", model.description().name)));
    }
    workload::matrices(&model)?;
    let is_empty = |quantity: &Declaration| quantity.is_constrained && model.constraint_rows() == 0;
    let is_often_used = |index: usize| arguments.all || OFTEN_USED.contains(&LIST[index].name);
    let is_usual = |&index: &usize| is_often_used(index) && LIST[index].of != Of::Task && !is_empty(&LIST[index]);
    let usual = (0..LIST.len()).filter(is_usual).map(Query::at);
    let mut asked: Vec<Query> = if arguments.quantity.is_empty() { usual.collect() } else { Vec::new() };
    for query in &arguments.quantity {
        if !asked.contains(query) {
            asked.push(*query);
        }
    }
    if asked.iter().any(|query| is_empty(query.declaration())) {
        needs_constraints(&model)?;
    }
    let needs_frame = |query: &Query| query.declaration().needs_frame() || query.declaration().uses == Uses::WRENCHES;
    let tip = if asked.iter().any(needs_frame) { end_effector(&model) } else { model.end_effector().ok() };
    let is_of_wrenches = |query: Query| query.declaration().uses == Uses::WRENCHES;
    let asked = asked
        .into_iter()
        .filter(|&query| tip.is_some() || !(query.declaration().needs_frame() || is_of_wrenches(query)));
    let queries: Vec<Query> = asked
        .map(|query| tip.filter(|_| query.declaration().needs_frame()).map_or(query, |tip| query.of(tip)))
        .collect();
    let queries = if arguments.quantity.is_empty() { missing::those_of(queries, &model) } else { queries };
    let threads = arguments.threads.unwrap_or_else(|| Batch::<f64>::of(&model).threads());
    let states = states(arguments.states, &model, &queries)?;
    let widest = queries.iter().flat_map(|query| query.input_lengths(&model)).max().unwrap_or(0);
    let data = Data::new(&model, states as usize, widest);
    let single = data.to_f32();

    interrupt::listen();
    let progress = Progress::new("timing", queries.len(), "quantities");
    let (mut timings, mut done) = (Vec::new(), 0);
    for &query in &queries {
        let tip = tip.filter(|_| is_of_wrenches(query));
        let mut runs = Subject { model: &model, query, tip }.runs(threads, &data, &single)?;
        let Some(found) = measure(hyphenated(query.name()), &mut runs, arguments.rounds.into())? else { break };
        timings.extend(found);
        done += 1;
        progress.at(done);
    }
    drop(progress);
    let (rounds, complete) = (arguments.rounds, done == queries.len());
    let report = Report { processor: processor(), states, rounds, threads, complete, timings };
    let text =
        if arguments.robot.json { page::object(&model, &report) } else { page::page(&model, &report, arguments.all) };
    if complete {
        return Ok(text);
    }
    failure::note(&format!("stopped by Ctrl-C: these are {done} of {} quantities", queries.len()));
    Err(Failure::Stopped(text))
}

/// The number of states in a batch: the given one, or as many as have results of the default size.
fn states(asked: Option<u32>, model: &Model, queries: &[Query]) -> Result<u32> {
    let numbers = queries.iter().map(|query| query.output_lengths(model).sum::<usize>()).max().unwrap_or(0).max(1);
    let most = |numbers_in_all: usize| u32::try_from(numbers_in_all / numbers).unwrap_or(u32::MAX).max(1);
    let Some(states) = asked else { return Ok(most(USUAL_NUMBERS).min(USUAL_STATES)) };
    if states > most(MOST_NUMBERS) {
        let bytes = workload::size(8.0 * numbers as f64 * f64::from(states));
        let most = most(MOST_NUMBERS);
        return Err(Failure::wrong(format!(
            "--states {states}: a result takes {bytes}, expected at most {most} states"
        )));
    }
    Ok(states)
}

/// Compares with one state, then times all in turn; nothing after Ctrl-C.
fn measure(name: String, runs: &mut [Run], rounds: usize) -> Result<Option<Vec<Timing>>> {
    let mut differences = Vec::new();
    let mut reference = Vec::new();
    for run in &mut *runs {
        if interrupt::is_requested() {
            return Ok(None);
        }
        let (way, results) = (run.way, run.results()?);
        if way.is_one {
            reference = results.clone();
        }
        let difference = reference.iter().zip(&results).map(|(a, b)| difference(a, b)).fold(0.0, f64::max);
        if way.precision == "f64" && !(difference <= ROUNDING) {
            let (title, engine) = (way.title(), run.engine());
            return Err(Failure::wrong(format!(
                "{name}, {title} by {engine}, differs from one state by {difference:.1e} of its largest entry, expected rounding"
            )));
        }
        differences.push(difference);
    }
    let mut times = vec![Vec::with_capacity(rounds); runs.len()];
    for _ in 0..rounds {
        for (run, times) in runs.iter_mut().zip(&mut times) {
            if interrupt::is_requested() {
                return Ok(None);
            }
            let start = Instant::now();
            run.run()?;
            times.push(start.elapsed().as_secs_f64() * 1e9 / run.states as f64);
        }
    }
    let all = runs.iter().zip(times).zip(differences);
    let timings = all.map(|((run, mut times), difference)| {
        times.sort_unstable_by(f64::total_cmp);
        let engine = run.engine();
        Timing { name: name.clone(), engine, way: run.way, least: times[0], median: times[times.len() / 2], difference }
    });
    Ok(Some(timings.collect()))
}

/// The difference over the first states, as many as both have.
fn difference(reference: &[f64], found: &[f64]) -> f64 {
    let largest = reference.iter().fold(0.0_f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    let apart = reference.iter().zip(found).map(|(a, b)| (a - b).abs());
    // a NaN counts as the largest
    apart.fold(0.0_f64, |m, x| if x <= m { m } else { x }) / largest
}

/// The processor's name, if the system provides it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or(format!("unknown {}", std::env::consts::ARCH), |(_, name)| name.to_string())
}
