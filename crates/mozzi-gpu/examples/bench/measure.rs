//! One kernel's speed and error.

use super::Speed;
use super::cases::Robot;
use mozzi::quantities::Query;
use mozzi_engine::CudaLayout;
use mozzi_gpu::{Device, DeviceArray, Number, Source};
use std::error::Error;
use std::time::Instant;

/// Repetitions, each long enough that the clock and the launch do not matter.
const REPETITIONS: usize = 7;
const SECONDS: f64 = 0.02;
/// States that are computed on the CPU, too.
const CHECKED: usize = 500;
/// Different random states; the rest repeats them.
const RANDOM: usize = 4096;

/// If fewer states fit than asked for, their number is a multiple of this: a column that begins within a 32-byte sector
/// of memory takes twice as long.
const MULTIPLE: usize = 1024;
/// Bytes of all arrays, at most: a humanoid's matrices would not fit.
const BYTES: usize = 1 << 30;

/// What both number types offer.
pub trait Real: Number + Into<f64> {
    const EPSILON: f64;
    fn of(x: f64) -> Self;
}
impl Real for f32 {
    const EPSILON: f64 = f32::EPSILON as f64;
    fn of(x: f64) -> Self {
        x as f32
    }
}
impl Real for f64 {
    const EPSILON: f64 = f64::EPSILON;
    fn of(x: f64) -> Self {
        x
    }
}

pub fn speed<T: Real>(
    device: &Device,
    robot: &Robot,
    query: Query,
    source: &Source,
    states: usize,
) -> Result<Speed, Box<dyn Error>> {
    let kernel = device.kernel(source)?;
    let fitting = BYTES / source.bytes_of_state();
    let states = if states <= fitting { states } else { fitting / MULTIPLE * MULTIPLE };
    let rows = rows(robot, query);
    let form = source.form();
    let place = |length: usize, i: usize, k: usize| match form.layout {
        CudaLayout::Rows => i * length + k,
        CudaLayout::Columns => k * states + i,
    };
    let host: Vec<Vec<T>> = rows
        .iter()
        .zip(source.inputs())
        .map(|(rows, input)| {
            let n = input.length;
            let mut array = vec![T::of(0.0); states * n];
            for i in 0..states {
                (0..n).for_each(|k| array[place(n, i, k)] = T::of(rows[(i % RANDOM) * n + k]));
            }
            array
        })
        .collect();
    let inputs = host.iter().map(|x| device.copy(x)).collect::<Result<Vec<_>, _>>()?;
    let zeros = source.outputs().iter().map(|output| device.zeros(output.length * states));
    let mut outputs = zeros.collect::<Result<Vec<DeviceArray<T>>, _>>()?;
    let mut run = |times: usize| -> Result<f64, Box<dyn Error>> {
        device.synchronize()?;
        let start = Instant::now();
        for _ in 0..times {
            kernel.run(&inputs.iter().collect::<Vec<_>>(), &mut outputs.iter_mut().collect::<Vec<_>>())?;
        }
        device.synchronize()?;
        Ok(start.elapsed().as_secs_f64() / times as f64)
    };
    run(3)?; // loads the code, and raises the clock
    let times = (SECONDS / run(3)?).ceil().clamp(1.0, 1e4) as usize;
    let mut seconds = (0..REPETITIONS).map(|_| run(times)).collect::<Result<Vec<f64>, _>>()?;
    seconds.sort_by(f64::total_cmp);
    let [median, most] = [seconds[REPETITIONS / 2], seconds[REPETITIONS - 1]];

    let slices: Vec<&[T]> = host.iter().map(Vec::as_slice).collect();
    let start = Instant::now();
    let found = kernel.compute(&slices)?;
    let with_transfer = states as f64 / start.elapsed().as_secs_f64();

    let mut error = 0.0_f64;
    let model = &robot.model;
    for i in (0..CHECKED.min(states)).map(|k| k * (states / CHECKED.min(states))) {
        let state: Vec<Vec<f64>> = host
            .iter()
            .zip(source.inputs())
            .map(|(x, input)| (0..input.length).map(|k| x[place(input.length, i, k)].into()).collect())
            .collect();
        let state: Vec<&[f64]> = state.iter().map(Vec::as_slice).collect();
        let expected = model.compute(query, &state, &model.environment())?;
        for ((found, expected), output) in found.iter().zip(expected).zip(source.outputs()) {
            let expected = if form.is_packed { lower_triangle(&expected) } else { expected };
            let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (k, &expected) in expected.iter().enumerate() {
                let found: f64 = found[place(output.length, i, k)].into();
                let difference = (found - expected).abs() / size;
                // a NaN stays
                error = if difference <= error || difference.is_nan() && error.is_nan() { error } else { difference };
            }
        }
    }
    let per_second = |seconds: f64| states as f64 / seconds;
    Ok(Speed {
        robot: robot.name.clone(),
        quantity: query.name(),
        form,
        registers: kernel.registers()?,
        bytes: source.bytes_of_state(),
        states_per_second: [per_second(median), per_second(most)],
        with_transfer,
        error: error / T::EPSILON,
    })
}

/// Random states, each array by rows.
fn rows(robot: &Robot, query: Query) -> Vec<Vec<f64>> {
    let names = query.declaration().inputs.iter().map(|input| input.name);
    let array = |name: &str| -> Vec<f64> {
        let entries = |seed: usize| {
            let [theta, dtheta, other] = mozzi::testing::state(&robot.model, seed as u64);
            match name {
                "theta" => theta,
                "dtheta" => dtheta,
                _ => other,
            }
        };
        (0..RANDOM).flat_map(entries).collect()
    };
    names.map(array).collect()
}

fn lower_triangle(M: &[f64]) -> Vec<f64> {
    let n = M.len().isqrt();
    (0..n).flat_map(|i| M[i * n..=i * n + i].to_vec()).collect()
}

/// Bytes a second that a kernel moves which only copies eight numbers a thread: what the memory gives at most.
pub fn bandwidth(device: &Device) -> Result<f64, Box<dyn Error>> {
    const NUMBERS: usize = 1 << 28;
    const TIMES: usize = 20;
    let program = mozzi_engine::record("copy", &[("x", 8)], |x| vec![("y", x[0].clone())]).expect("short");
    let form = mozzi_gpu::Form { layout: CudaLayout::Columns, ..mozzi_gpu::Form::default() };
    let kernel = device.kernel(&Source::of_program("plain", &program, form)?)?;
    let (from, mut to) = (device.zeros::<f32>(NUMBERS)?, device.zeros::<f32>(NUMBERS)?);
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        device.synchronize()?;
        let start = Instant::now();
        for _ in 0..TIMES {
            kernel.run(&[&from], &mut [&mut to])?;
        }
        device.synchronize()?;
        best = best.min(start.elapsed().as_secs_f64() / TIMES as f64);
    }
    Ok(2.0 * 4.0 * NUMBERS as f64 / best)
}
