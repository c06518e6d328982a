//! `cargo xtask gpu-bench`: states a second on this machine's GPU, into benches/GPU.md. Without a GPU it fails with "no
//! CUDA device" and writes nothing. Arguments: those of `cases`, and `--states N`.

#[path = "../cases/mod.rs"]
mod cases;
mod measure;
mod page;
mod rollout;

use cases::Arguments;
use mozzi_engine::Precision;
use mozzi_gpu::{Device, Form, Nvrtc, Source};
use std::error::Error;
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
    cases::run(run)
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let device = Device::first()?;
    let nvrtc = Nvrtc::find()?;
    let states = arguments.option("--states").map_or(Ok(STATES), str::parse)?;
    let mut speeds = Vec::new();
    let robots = arguments.robots()?;
    for (robot, query, form) in arguments.kernels(&robots) {
        let source = Source::new(&robot.model, query, form)?;
        let speed = match form.precision {
            Precision::F32 => measure::speed::<f32>(&device, robot, query, &source, states)?,
            Precision::F64 => measure::speed::<f64>(&device, robot, query, &source, states)?,
        };
        eprintln!(
            "{} {} {:?}: {:.3e} states/s, {:.3e} with transfers, {:.1} eps",
            speed.robot, speed.quantity, speed.form, speed.states_per_second[0], speed.with_transfer, speed.error
        );
        speeds.push(speed);
    }
    let rollouts = rollout::seconds(&device, &robots)?;
    let bandwidth = measure::bandwidth(&device)?;
    arguments.write(&page::text(&device, &nvrtc, states, bandwidth, &speeds, &rollouts)?)
}
