//! `mozzi batch`: a quantity at every state of a file, on all cores.

use crate::batch::compute::compute;
use crate::batch::format::Format;
use crate::batch::npy::tuple;
use crate::batch::quantity::{Precision, Quantity, instruction_set};
use crate::batch::results::{self, nan};
use crate::batch::states::States;
use crate::failure::{self, Failure, Result};
use crate::json;
use crate::robot::RobotArguments;
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_batch::{Batch, InstructionSet};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct BatchArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// What is computed
    #[arg(long, value_name = "NAME")]
    quantity: Quantity,
    /// The states: .npy, .npz, .arrow, .feather or .csv ("-": CSV on standard input)
    #[arg(long = "in", value_name = "STATES")]
    input: String,
    /// Where the results go, by the same endings ("-": CSV on standard output)
    #[arg(long = "out", value_name = "RESULT")]
    output: String,
    /// The numbers that are computed with, and written
    #[arg(long, default_value = "f64")]
    precision: Bits,
    /// At most as many threads [default: one a core]
    #[arg(long, value_name = "K")]
    threads: Option<usize>,
    /// Registers: portable, avx2 or avx512 [default: the widest that the machine has]
    #[arg(long, value_name = "NAME", value_parser = instruction_set)]
    instruction_set: Option<InstructionSet>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Bits {
    F64,
    F32,
}

/// One a core.
pub fn all_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A batch's error outside of any file.
pub fn wrong(error: mozzi_batch::Error) -> Failure {
    Failure::wrong(error.to_string())
}

pub fn run(arguments: &BatchArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    match arguments.precision {
        Bits::F64 => run_in::<f64>(arguments, &model),
        Bits::F32 => run_in::<f32>(arguments, &model),
    }
}

fn run_in<T: Precision>(arguments: &BatchArguments, model: &Model) -> Result<String> {
    let quantity = arguments.quantity;
    let (input, output) = (arguments.input.as_str(), arguments.output.as_str());
    if arguments.robot.json && output == "-" {
        return Err(Failure::wrong("--json and --out - both ask for standard output, expected one of them"));
    }
    let format = Format::of_results(output, quantity)?;
    let threads = arguments.threads.unwrap_or_else(all_threads);
    let mut batch = Batch::<T>::of(model).with_threads(threads).map_err(wrong)?;
    if let Some(set) = arguments.instruction_set {
        batch = batch.with_instruction_set(set).map_err(wrong)?;
    }
    if quantity.is_of_a_frame() {
        model.end_effector()?; // before all states are read
    }
    let states = States::read(input, model, quantity)?;
    let all = states.count;
    let (outputs, seconds) = compute(&batch, quantity, states, model.environment())?;
    let count = outputs.first().map_or(0, |output| output.shape[0]);
    let text = results::write(output, format, model, &outputs)?;

    let (registers, rate) = (batch.instruction_set().name(), count as f64 / seconds.max(1e-9));
    let arrays: Vec<String> = outputs.iter().map(|o| format!("{} {}", o.name, tuple(&o.shape))).collect();
    let nan = nan(&outputs, count);
    if nan > 0 {
        failure::note(&format!("{nan} of {count} states gave NaN"));
    }
    let answer = |text: String| {
        if count == all {
            return Ok(text);
        }
        failure::note(&format!("stopped by Ctrl-C: these are the first {count} of {all} states"));
        Err(Failure::Stopped(text))
    };
    if !arguments.robot.json {
        let of_threads = if threads == 1 { "1 thread".to_string() } else { format!("{threads} threads") };
        failure::write(&format!(
            "{count} states in {seconds:.3} s, {rate:.3e} states/s ({}, {registers}, {of_threads}): {} in {output}\n",
            T::NAME,
            arrays.join(", "),
        ));
        return answer(text);
    }
    let shapes = outputs.iter().map(|o| json!({ "name": o.name, "shape": o.shape })).collect::<Value>();
    answer(json::print(&json::of_robot(
        model,
        json!({
            "quantity": quantity.name(), "in": input, "out": output, "arrays": shapes, "states": count, "complete": count == all,
            "states_with_nan": nan, "seconds": seconds, "states_per_second": rate, "precision": T::NAME,
            "instruction_set": registers, "threads": threads,
        }),
    )))
}
