//! A quantity at every state of a file, on all cores, with progress.

use super::{gpu, subject};
use crate::failure::{self, Failure, Result};
use crate::progress::Progress;
use crate::quantity::hyphenated;
use crate::robot::RobotArguments;
use crate::tables::array::{Array, tuple};
use crate::tables::format::Format;
use crate::tables::precision::Precision;
use crate::tables::results::{self, nan};
use crate::tables::states::States;
use crate::{interrupt, json};
use clap::Args;
use mozzi::quantities::Query;
use mozzi::{Environment, FrameId, Model};
use mozzi_engine::{Batch, BatchEnvironment, Error};
use mozzi_urdf::counted;
use serde_json::{Map, Value, json};
use std::time::{Duration, Instant};

/// The first piece has this many states; each next piece has twice or half as many, until the time for a piece is
/// between these bounds.
const FIRST: usize = 256;
const PIECE: [Duration; 2] = [Duration::from_millis(40), Duration::from_millis(160)];

#[derive(Args, Debug)]
pub struct TableArguments {
    /// Read states from a file instead of flags: .npy, .npz or .csv ("-": CSV on standard input); .arrow, .feather and
    /// .parquet if built with these features
    #[arg(long = "in", value_name = "STATES")]
    pub input: Option<String>,
    /// File for the results, with the same endings [default: CSV on standard output, "-"]
    #[arg(long = "out", value_name = "RESULT")]
    output: Option<String>,
    /// Precision of the computation and of the results [default: f64]
    #[arg(long, value_parser = ["f64", "f32"])]
    precision: Option<String>,
    /// Maximum number of threads [default: one per core]
    #[arg(long, value_name = "K")]
    threads: Option<usize>,
    /// Make no machine code: the numbers are those at one state, to the bit
    #[arg(long)]
    kernels_only: bool,
    /// Compute on the first NVIDIA GPU, by NVRTC (docs/gpu-guide.md)
    #[arg(long, conflicts_with_all = ["threads", "kernels_only"])]
    pub gpu: bool,
}

/// A computation at all states of a file.
pub struct Job<'a> {
    pub file: &'a str,
    pub query: Query<'a>,
    pub model: &'a Model,
    pub environment: Environment<'a>,
    pub table: &'a TableArguments,
    pub robot: &'a RobotArguments,
}

impl Job<'_> {
    /// Without `--out`, JSON contains the results; with it, a summary and the file's name.
    pub fn run(&self) -> Result<String> {
        if self.table.precision.as_deref() == Some("f32") { self.run_in::<f32>() } else { self.run_in::<f64>() }
    }

    fn run_in<T: Precision>(&self) -> Result<String> {
        let &Job { file, query, model, environment, table: arguments, robot } = self;
        let output = arguments.output.as_deref();
        json::unless_rows(robot.json, output)?;
        Format::of_results(output.unwrap_or("-"), query)?;
        query.check_subject(model)?; // before all states are read
        let mut batch = Batch::<T>::of(model);
        if let Some(threads) = arguments.threads {
            batch = batch.with_threads(threads)?;
        }
        if arguments.kernels_only {
            batch = batch.kernels_only();
        }
        // before all states are read, too
        let kernel = if arguments.gpu { Some(gpu::kernel::<T>(query, model)?) } else { None };
        if arguments.gpu && !environment.applied.is_empty() {
            return Err(Failure::wrong("--gpu: wrenches are given, expected none"));
        }
        let states = States::<T>::read(file, query, model, environment.applied)?;
        if robot.gravity.is_some() && states.gravity.is_some() {
            return Err(Failure::wrong(format!(
                "--gravity and the array `gravity` of {file} are both given, expected one of them"
            )));
        }
        let frames =
            states.wrenches.iter().map(|(frame, _)| frame).chain(environment.applied.iter().map(|(frame, _)| frame));
        let has_tip = model.end_effector().is_ok_and(|tip| frames.copied().any(|frame| frame == tip));
        if robot.end_effector.is_some() && !query.declaration().needs_frame() && !has_tip {
            return Err(Failure::wrong(format!("--frame has no effect: {file} has no wrench of that frame")));
        }
        // the states are computed in pieces: by one engine
        let wrenches: Vec<(FrameId, &[T])> =
            states.wrenches.iter().map(|(frame, table)| (*frame, &table[..])).collect();
        let (gravity, parameters) = (states.gravity.as_deref(), states.parameters.as_deref());
        let around = BatchEnvironment { environment, wrenches: &wrenches, gravity, parameters };
        let start = Instant::now();
        if kernel.is_none() {
            batch = batch.for_job_of(&[query], &around, states.samples.count)?;
        }
        let (results, seconds) = match &kernel {
            Some(kernel) => gpu::compute(kernel, query, model, &states)?,
            None => compute(&batch, query, &states, &around).map(|results| (results, start.elapsed().as_secs_f64()))?,
        };
        let (count, all) = (results.first().map_or(0, |array| array.shape[0]), states.samples.count);
        let nan = nan(&results, count);
        if nan > 0 {
            failure::note(&format!("{nan} of {count} states gave NaN"));
        }
        let text = match output {
            None if robot.json => json::print(&object(query, model, &states, &results)),
            _ => results::write(output.unwrap_or("-"), query, model, &states, &results)?,
        };
        let (engine, threads) = match &kernel {
            Some(kernel) => (kernel.device().name().to_string(), 1),
            None => (batch.engine_in(query, &around).to_string(), batch.threads().min(count.max(1))),
        };
        let rate = count as f64 / seconds.max(1e-9);
        let text = match output {
            Some(output) if robot.json => {
                let arrays: Value =
                    results.iter().map(|array| json!({ "name": array.name, "shape": array.shape })).collect();
                json::print(&json::of_robot(
                    model,
                    json!({
                        "quantity": hyphenated(query.name()), "in": file, "out": output, "arrays": arrays, "states": count,
                        "complete": count == all, "states_with_nan": nan, "seconds": seconds, "states_per_second": rate,
                        "precision": T::NAME, "engine": engine, "threads": threads,
                    }),
                ))
            }
            _ => {
                let arrays: Vec<String> =
                    results.iter().map(|array| format!("{} {}", array.name, tuple(&array.shape))).collect();
                let of_threads =
                    if kernel.is_some() { "transfers included".to_string() } else { counted(threads, "thread") };
                let place = output.filter(|file| *file != "-").unwrap_or("standard output");
                failure::write(&format!(
                    "{} in {seconds:.3} s, {rate:.3e} states/s ({}, {engine}, {of_threads}): {} in {place}\n",
                    counted(count, "state"),
                    T::NAME,
                    arrays.join(", "),
                ));
                text
            }
        };
        if count == all {
            return Ok(text);
        }
        failure::note(&format!("stopped by Ctrl-C: these are the first {count} of {all} states"));
        Err(Failure::Stopped(text))
    }
}

/// The results; after Ctrl-C, of the states computed so far.
fn compute<T: Precision>(
    batch: &Batch<T>,
    query: Query,
    states: &States<T>,
    around: &BatchEnvironment<T>,
) -> Result<Vec<Array<T>>> {
    let count = states.samples.count;
    let mut results = results::arrays::<T>(query, batch.model(), count);
    interrupt::listen();
    let progress = Progress::new(hyphenated(query.name()), count, "states");
    let (mut first, mut piece) = (0, FIRST);
    while first < count && !interrupt::is_requested() {
        let (begin, these) = (Instant::now(), piece.min(count - first));
        let inputs: Vec<&[T]> = states.inputs.iter().map(|table| part(table, count, first, these)).collect();
        let wrenches: Vec<(FrameId, &[T])> =
            around.wrenches.iter().map(|&(frame, table)| (frame, part(table, count, first, these))).collect();
        let environment = BatchEnvironment {
            environment: around.environment,
            wrenches: &wrenches,
            gravity: around.gravity.map(|table| part(table, count, first, these)),
            parameters: around.parameters.map(|table| part(table, count, first, these)),
        };
        let mut outputs: Vec<&mut [T]> = results
            .iter_mut()
            .map(|array| {
                let width = array.width();
                &mut array.values[first * width..][..these * width]
            })
            .collect();
        batch.compute(query, &inputs, &environment, &mut outputs).map_err(|error| match error {
            Error::State { index, source } => {
                Failure::wrong(format!("{}: {source}", states.samples.place(first + index)))
            }
            other => Failure::wrong(format!("{}: {other}", states.samples.file)),
        })?;
        first += these;
        progress.at(first);
        piece = match begin.elapsed() {
            short if short < PIECE[0] => piece.saturating_mul(2),
            long if long > PIECE[1] => (piece / 2).max(1),
            _ => piece,
        };
    }
    results.iter_mut().for_each(|array| array.truncate(first));
    Ok(results)
}

/// A range of states from a table with `count` states.
fn part<T>(table: &[T], count: usize, first: usize, these: usize) -> &[T] {
    let width = table.len() / count;
    &table[first * width..][..these * width]
}

/// The computed states and the results, by name.
fn object<T: Precision>(query: Query, model: &Model, states: &States<T>, results: &[Array<T>]) -> Value {
    let count = results.first().map_or(0, |array| array.shape[0]);
    let rows = |table: &[T]| {
        let width = table.len() / states.samples.count.max(1);
        let values: Vec<f64> = table[..count * width].iter().map(|&x| x.into()).collect();
        json::nested(&[count, width], &values)
    };
    let mut object = subject::object(query, model);
    if let Some(t) = &states.samples.t {
        object.insert("t".into(), json::vector(&t[..count]));
    }
    for (input, table) in query.declaration().inputs.iter().zip(&states.inputs) {
        object.insert(input.name.into(), rows(table));
    }
    if !states.wrenches.is_empty() {
        let wrench = |(frame, table): &(FrameId, Vec<T>)| (model.frame_name(*frame).into(), rows(table));
        object.insert("wrenches".into(), states.wrenches.iter().map(wrench).collect::<Map<_, _>>().into());
    }
    for array in results {
        let values: Vec<f64> = array.values.iter().map(|&x| x.into()).collect();
        object.insert(array.name.clone(), json::nested(&array.shape, &values));
    }
    json::of_robot(model, object.into())
}
