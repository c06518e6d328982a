//! `mozzi bench`: this machine's times, of one state and of many.

use super::batch::{all_threads, wrong};
use crate::batch::one_state::OneState;
use crate::batch::quantity::{Precision, Quantity, Shape};
use crate::batch::results::Output;
use crate::batch::states::width;
use crate::failure::{self, Failure, Result};
use crate::progress::Progress;
use crate::robot::{RobotArguments, end_effector};
use crate::text::{Page, about, table};
use crate::{interrupt, json};
use clap::{Args, ValueEnum};
use mozzi::{Environment, FrameId, Model, Wrench};
use mozzi_batch::{Batch, BatchEnvironment, InstructionSet};
use mozzi_compare::Random;
use serde_json::{Value, json};
use std::hint::black_box;
use std::time::Instant;

/// States that are computed one by one.
const ONE_BY_ONE: usize = 1024;
/// Of the largest entry: a larger difference between one state and many is no rounding.
const ROUNDING: f64 = 1e-6;

#[derive(Args, Debug)]
pub struct BenchArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// States in a batch
    #[arg(long, value_name = "N", default_value_t = 16384, value_parser = clap::value_parser!(u32).range(1..))]
    states: u32,
    /// Threads of the second table [default: one a core]
    #[arg(long, value_name = "K")]
    threads: Option<usize>,
    /// How often each is timed, in turn with the others
    #[arg(long, value_name = "R", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Only this; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    quantity: Vec<Quantity>,
}

/// How a quantity is computed.
#[derive(Clone, Copy, PartialEq)]
struct Way {
    /// None: one state at a time.
    set: Option<InstructionSet>,
    precision: &'static str,
    threads: usize,
}

/// What came of it: nanoseconds a state, and the largest difference from one state, of the largest entry.
struct Timing {
    quantity: Quantity,
    way: Way,
    least: f64,
    median: f64,
    difference: f64,
}

/// Random states: θ, θ̇, and θ̈ or τ.
struct Data<T> {
    tables: [Vec<T>; 3],
    wrenches: Vec<T>,
}

impl Data<f64> {
    fn new(model: &Model, states: usize) -> Self {
        let mut random = Random(1);
        let mut numbers = |count: usize| (0..count).map(|_| random.number()).collect::<Vec<f64>>();
        let theta = (0..states).flat_map(|_| {
            let mut theta: Vec<f64> = model.neutral_configuration();
            mozzi::integrate(model, &mut theta, &numbers(model.n()), 1.0);
            theta
        });
        let theta = theta.collect();
        let tables = [theta, numbers(states * model.n()), numbers(states * model.n())];
        Data { tables, wrenches: numbers(states * 6) }
    }

    fn to_f32(&self) -> Data<f32> {
        let rounded = |table: &Vec<f64>| table.iter().map(|&x| x as f32).collect();
        Data { tables: self.tables.each_ref().map(rounded), wrenches: rounded(&self.wrenches) }
    }
}

/// One computation of all states, that can be repeated.
trait Run {
    fn run(&mut self) -> Result<()>;
    fn states(&self) -> usize;
    /// All outputs, as f64.
    fn results(&self) -> Vec<Vec<f64>>;
}

struct One<'a> {
    model: &'a Model,
    state: OneState<'a>,
    quantity: Quantity,
    data: &'a Data<f64>,
    tip: Option<FrameId>,
    /// Each state's outputs, one after the other.
    outputs: Vec<f64>,
    count: usize,
}

impl Run for One<'_> {
    fn run(&mut self) -> Result<()> {
        let own = self.outputs.len() / self.count;
        let at = |k: usize, name: &str, state: usize| {
            let width = width(self.model, name);
            &self.data.tables[k][state * width..][..width]
        };
        for (state, out) in self.outputs.chunks_exact_mut(own).enumerate() {
            let F: [f64; 6] = std::array::from_fn(|k| self.data.wrenches[state * 6 + k]);
            let applied = self.tip.map(|tip| (tip, Wrench::from_array(F)));
            let environment = Environment { applied: applied.as_slice(), ..self.model.environment() };
            let of_state = [at(0, "theta", state), at(1, "dtheta", state), at(2, "ddtheta", state)];
            self.state.evaluate(self.quantity, of_state, &environment, black_box(out));
        }
        Ok(())
    }

    fn states(&self) -> usize {
        self.count
    }

    fn results(&self) -> Vec<Vec<f64>> {
        let width = self.outputs.len() / self.count;
        let mut first = 0;
        let of_output = |output: &(&str, Shape)| {
            let own: usize = output.1.of(self.model.n()).iter().product();
            let part = first..first + own;
            first += own;
            self.outputs.chunks_exact(width).flat_map(|row| row[part.clone()].to_vec()).collect()
        };
        self.quantity.outputs().iter().map(of_output).collect()
    }
}

struct Many<'a, T: Precision> {
    batch: Batch<T>,
    quantity: Quantity,
    data: &'a Data<T>,
    tip: Option<FrameId>,
    outputs: Vec<Output<T>>,
}

impl<T: Precision> Run for Many<'_, T> {
    fn run(&mut self) -> Result<()> {
        let input = |name: &'static str| {
            let k = ["theta", "dtheta"].iter().position(|known| *known == name).unwrap_or(2);
            &self.data.tables[k][..]
        };
        let wrenches: Vec<(FrameId, &[T])> = self.tip.map(|tip| (tip, &self.data.wrenches[..])).into_iter().collect();
        let surroundings = BatchEnvironment { environment: self.batch.model().environment(), wrenches: &wrenches };
        let outputs = self.outputs.iter_mut().map(|output| black_box(&mut output.values[..])).collect();
        T::evaluate(&self.batch, self.quantity, &input, &surroundings, outputs).map_err(wrong)
    }

    fn states(&self) -> usize {
        self.data.wrenches.len() / 6
    }

    fn results(&self) -> Vec<Vec<f64>> {
        self.outputs.iter().map(|output| output.values.iter().map(|&x| x.to_f64()).collect()).collect()
    }
}

pub fn run(arguments: &BenchArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    if model.n() == 0 {
        return Err(Failure::wrong(format!("`{}` has no joint that moves: nothing to time", model.description().name)));
    }
    let tip = end_effector(&model);
    let needs_tip = |quantity: Quantity| quantity.is_of_a_frame() || quantity == Quantity::TipForces;
    let asked = if arguments.quantity.is_empty() { Quantity::value_variants() } else { &arguments.quantity };
    let quantities: Vec<Quantity> = asked.iter().copied().filter(|&q| tip.is_some() || !needs_tip(q)).collect();
    let threads = arguments.threads.unwrap_or_else(all_threads);
    let data = Data::new(&model, arguments.states as usize);
    let single = data.to_f32();

    interrupt::listen();
    let progress = Progress::new("timing", quantities.len(), "quantities");
    let (mut timings, mut done) = (Vec::new(), 0);
    for &quantity in &quantities {
        let tip = tip.filter(|_| quantity == Quantity::TipForces);
        let mut runs = runs(&model, quantity, tip, threads, &data, &single)?;
        let Some(found) = measure(quantity, &mut runs, arguments.rounds.into())? else { break };
        timings.extend(found);
        done += 1;
        progress.at(done);
    }
    drop(progress);
    let processor = processor();
    let text = match arguments.robot.json {
        true => object(&model, &timings, &processor, arguments, done == quantities.len()),
        false => page(&model, &timings, &processor, arguments, threads),
    };
    if done == quantities.len() {
        return Ok(text);
    }
    failure::note(&format!("stopped by Ctrl-C: these are {done} of {} quantities", quantities.len()));
    Err(Failure::Stopped(text))
}

type Runs<'a> = Vec<(Way, Box<dyn Run + 'a>)>;

fn runs<'a>(
    model: &'a Model,
    quantity: Quantity,
    tip: Option<FrameId>,
    threads: usize,
    data: &'a Data<f64>,
    single: &'a Data<f32>,
) -> Result<Runs<'a>> {
    let count = (data.wrenches.len() / 6).min(ONE_BY_ONE);
    let width: usize =
        quantity.outputs().iter().map(|(_, at_one)| at_one.of(model.n()).iter().product::<usize>()).sum();
    let one = One { model, state: OneState::new(model), quantity, data, tip, outputs: vec![0.0; count * width], count };
    let mut runs: Runs = vec![(Way { set: None, precision: f64::NAME, threads: 1 }, Box::new(one))];
    let mut counts = vec![1, threads];
    counts.dedup();
    for threads in counts {
        for set in InstructionSet::available() {
            let way = |precision| Way { set: Some(set), precision, threads };
            runs.push((way(f64::NAME), many(model, quantity, tip, set, threads, data)?));
            runs.push((way(f32::NAME), many(model, quantity, tip, set, threads, single)?));
        }
    }
    Ok(runs)
}

fn many<'a, T: Precision>(
    model: &Model,
    quantity: Quantity,
    tip: Option<FrameId>,
    set: InstructionSet,
    threads: usize,
    data: &'a Data<T>,
) -> Result<Box<dyn Run + 'a>> {
    let batch = Batch::<T>::of(model).with_instruction_set(set).and_then(|batch| batch.with_threads(threads));
    let states = data.wrenches.len() / 6;
    let outputs = quantity.outputs().iter().map(|&output| Output::new(model, output, states)).collect();
    Ok(Box::new(Many { batch: batch.map_err(wrong)?, quantity, data, tip, outputs }))
}

/// Compares with one state, then times all in turn; nothing, where Ctrl-C asked to end.
fn measure(quantity: Quantity, runs: &mut Runs, rounds: usize) -> Result<Option<Vec<Timing>>> {
    let mut differences = Vec::new();
    let mut reference = Vec::new();
    for (way, run) in runs.iter_mut() {
        if interrupt::asked() {
            return Ok(None);
        }
        run.run()?;
        let results = run.results();
        if way.set.is_none() {
            reference = results.clone();
        }
        let difference = reference.iter().zip(&results).map(|(a, b)| difference(a, b)).fold(0.0, f64::max);
        if way.precision == f64::NAME && !(difference <= ROUNDING) {
            let set = way.set.map_or("one state", InstructionSet::name);
            return Err(Failure::wrong(format!(
                "{} on {set} differs from one state by {difference:.1e} of its largest entry, expected rounding",
                quantity.name()
            )));
        }
        differences.push(difference);
    }
    let mut times = vec![Vec::with_capacity(rounds); runs.len()];
    for _ in 0..rounds {
        for ((_, run), times) in runs.iter_mut().zip(&mut times) {
            if interrupt::asked() {
                return Ok(None);
            }
            let start = Instant::now();
            run.run()?;
            times.push(start.elapsed().as_secs_f64() * 1e9 / run.states() as f64);
        }
    }
    let all = runs.iter().zip(times).zip(differences);
    let timings = all.map(|(((way, _), mut times), difference)| {
        times.sort_by(f64::total_cmp);
        Timing { quantity, way: *way, least: times[0], median: times[times.len() / 2], difference }
    });
    Ok(Some(timings.collect()))
}

/// Of the first states, as many as are in both.
fn difference(reference: &[f64], found: &[f64]) -> f64 {
    let largest = reference.iter().fold(0.0_f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    let apart = reference.iter().zip(found).map(|(a, b)| (a - b).abs());
    // a NaN is the largest of all
    apart.fold(0.0_f64, |m, x| if x <= m { m } else { x }) / largest
}

/// The processor's name, where the system tells it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or(format!("unknown {}", std::env::consts::ARCH), |(_, name)| name.to_string())
}

fn sets() -> Vec<&'static str> {
    InstructionSet::available().into_iter().map(InstructionSet::name).collect()
}

fn object(model: &Model, timings: &[Timing], processor: &str, arguments: &BenchArguments, complete: bool) -> String {
    let entry = |timing: &Timing| {
        json!({
            "quantity": timing.quantity.name(),
            "instruction_set": timing.way.set.map(InstructionSet::name),
            "one_state": timing.way.set.is_none(),
            "precision": timing.way.precision,
            "threads": timing.way.threads,
            "ns_least": timing.least,
            "ns_median": timing.median,
            "states_per_second": 1e9 / timing.median,
            "difference": timing.difference,
        })
    };
    json::print(&json::of_robot(
        model,
        json!({
            "processor": processor, "instruction_sets": sets(), "states": arguments.states,
            "rounds": arguments.rounds, "complete": complete, "timings": timings.iter().map(entry).collect::<Value>(),
        }),
    ))
}

fn page(model: &Model, timings: &[Timing], processor: &str, arguments: &BenchArguments, threads: usize) -> String {
    let mut page = Page::default();
    page.line(format!("{}: {} positions, {} velocities", model.description().name, model.nq(), model.n()));
    page.line(format!("{processor}; {}; {threads} threads at most", sets().join(", ")));
    let BenchArguments { states, rounds, .. } = arguments;
    page.line(format!("{states} states a batch; least / median of {rounds} rounds, all in turn"));
    let time = |timing: &Timing| format!("{} / {}", digits(timing.least), digits(timing.median));
    let rate = |timing: &Timing| format!("{} / {}", digits(1e3 / timing.least), digits(1e3 / timing.median));
    let one_thread = |way: Way| way.threads == 1;
    page.title("nanoseconds a state, on one thread").lines(&grid(timings, one_thread, time));
    if threads > 1 {
        let title = format!("millions of states a second, on {threads} threads");
        page.title(&title).lines(&grid(timings, |way| way.threads > 1, rate));
    }
    let error = |timing: &Timing| about(timing.difference);
    page.title("largest difference from one state, of the largest entry").lines(&grid(timings, one_thread, error));
    page.end()
}

/// A row for each quantity, a column for each way.
fn grid(timings: &[Timing], which: impl Fn(Way) -> bool, cell: impl Fn(&Timing) -> String) -> Vec<String> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut head = vec![String::new()];
    for timing in timings.iter().filter(|timing| which(timing.way)) {
        let (way, name) = (timing.way, timing.quantity.name());
        let title = way.set.map_or("one state".to_string(), |set| format!("{} {}", set.name(), way.precision));
        if !head.contains(&title) {
            head.push(title);
        }
        match rows.last_mut().filter(|row| row[0] == name) {
            Some(row) => row.push(cell(timing)),
            None => rows.push(vec![name, cell(timing)]),
        }
    }
    table(&[vec![head], rows].concat(), "lr")
}

/// Three digits.
fn digits(x: f64) -> String {
    let places = (2 - x.abs().max(1e-9).log10().floor() as i32).clamp(0, 4) as usize;
    format!("{x:.places$}")
}
