//! `cargo xtask gpu-bench`: states a second on this machine's GPU, into benches/GPU.md. Without a GPU it fails with "no
//! CUDA device" and writes nothing. Arguments: `--robots FOLDER` of example-robot-data, `--only NAME` of a robot,
//! `--quantity NAME`, `--states N`, `--page FILE` (else standard output).

#[path = "../cases/mod.rs"]
mod cases;
mod measure;
mod page;
mod rollout;

use mozzi_codegen::Precision;
use mozzi_gpu::{Device, Form, Nvrtc, Source};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// States of each array: many waves of threads, and more than the caches hold.
const STATES: usize = 1 << 22;

/// A measured kernel.
pub struct Speed {
    robot: String,
    quantity: &'static str,
    form: Form,
    registers: usize,
    bytes: usize,
    /// States a second on arrays of the device, median and least of the repetitions.
    states_per_second: [f64; 2],
    /// With both copies, from and to pageable memory.
    with_transfer: f64,
    /// Largest error against the CPU in f64, relative to a state's largest entry, in ε of the precision.
    error: f64,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str| arguments.iter().position(|x| x == name).and_then(|k| arguments.get(k + 1));
    let device = Device::first()?;
    let nvrtc = Nvrtc::find()?;
    let states = option("--states").map_or(Ok(STATES), |text| text.parse())?;
    let only = option("--only");
    let mut speeds = Vec::new();
    let robots = cases::robots(option("--robots").map(Path::new))?;
    for robot in robots.iter().filter(|robot| only.is_none_or(|name| *name == robot.name)) {
        for (precision, layout) in cases::FORMS {
            for (query, is_packed) in cases::quantities(option("--quantity").map(String::as_str)) {
                let source = Source::new(&robot.model, query, Form { precision, layout, is_packed })?;
                let speed = match precision {
                    Precision::F32 => measure::speed::<f32>(&device, robot, query, &source, states)?,
                    Precision::F64 => measure::speed::<f64>(&device, robot, query, &source, states)?,
                };
                eprintln!(
                    "{} {} {:?}: {:.3e} states/s, {:.3e} with transfers, {:.1} eps",
                    speed.robot,
                    speed.quantity,
                    speed.form,
                    speed.states_per_second[0],
                    speed.with_transfer,
                    speed.error
                );
                speeds.push(speed);
            }
        }
    }
    let rollouts = rollout::seconds(&device, &robots)?;
    let bandwidth = measure::bandwidth(&device)?;
    let text = page::text(&device, &nvrtc, states, bandwidth, &speeds, &rollouts)?;
    match option("--page") {
        Some(path) => std::fs::write(path, text)?,
        None => println!("{text}"),
    }
    Ok(())
}
