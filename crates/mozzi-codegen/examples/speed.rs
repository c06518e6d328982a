//! Machine code beside `mozzi::native` at one state and `mozzi-batch` at many, in one interleaved run on one thread: the least of
//! many rounds, in nanoseconds a state.
//!
//! `cargo run --release -p mozzi-codegen --example speed [ROBOT …]`

use mozzi::{Model, native};
use mozzi_batch::Batch;
use mozzi_codegen::{Compiled, Kernel, LeftOpen, Quantity, Shape, compile};
use std::hint::black_box;
use std::time::Instant;

const STATES: usize = 256;
const ROUNDS: usize = 60;

/// Numbers in [−size, size), always the same.
fn numbers(count: usize, size: f64, mut seed: u64) -> Vec<f64> {
    let mut next = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| size * next()).collect()
}

fn robot(name: &str) -> Result<Model, Box<dyn std::error::Error>> {
    let model = mozzi_urdf::open(name)?.build()?;
    Ok(if name == "panda" { model.with_locked_joints(&[("panda_finger_joint1", 0.0)])? } else { model })
}

type Run<'r> = Box<dyn FnMut() + 'r>;

fn at_one_state<'r>(
    model: &'r Model,
    robot: &'r Compiled,
    quantity: Quantity,
    [theta, dtheta, x]: [&'r [f64]; 3],
) -> [Run<'r>; 2] {
    let (n, nq, environment) = (model.n(), model.nq(), model.environment());
    let (mut w, mut out, mut out3) = (native::Workspace::new(model), vec![0.0; n * n], vec![0.0; 3 * n * n]);
    let kernels = move || {
        for k in 0..STATES {
            let (q, v, a) = (&theta[nq * k..][..nq], &dtheta[n * k..][..n], &x[n * k..][..n]);
            let (first, others) = out3.split_at_mut(n * n);
            let three = [first, &mut others[..n * n], &mut out[..]];
            match quantity {
                Quantity::InverseDynamics => {
                    native::inverse_dynamics(model, q, v, a, &environment, &mut w, &mut out[..n])
                }
                Quantity::MassMatrix => native::mass_matrix(model, q, &mut w, &mut out),
                Quantity::ForwardDynamics => {
                    native::forward_dynamics(model, q, v, a, &environment, &mut w, &mut out[..n])
                }
                _ => native::inverse_dynamics_derivatives(model, q, v, a, &environment, &mut w, three),
            }
            black_box(&mut out);
        }
    };
    let (mut a, mut b, mut c) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    let machine = move || {
        for k in 0..STATES {
            let state = [&theta[nq * k..][..nq], &dtheta[n * k..][..n], &x[n * k..][..n]];
            match quantity {
                Quantity::InverseDynamics => robot.evaluate(quantity, &state, &mut [&mut a[..n]]),
                Quantity::MassMatrix => robot.evaluate(quantity, &state[..1], &mut [&mut a]),
                Quantity::ForwardDynamics => robot.evaluate(quantity, &state, &mut [&mut a[..n], &mut b[..n]]),
                _ => robot.evaluate(quantity, &state, &mut [&mut a, &mut b, &mut c]),
            }
            black_box(&mut a);
        }
    };
    [Box::new(kernels), Box::new(machine)]
}

fn at_many_states<'r>(
    batch: &'r Batch,
    robot: &'r Compiled,
    quantity: Quantity,
    [theta, dtheta, x]: [&'r [f64]; 3],
) -> [Run<'r>; 2] {
    let n = batch.model().n();
    let environment = batch.model().environment().into();
    let out = || vec![0.0; STATES * n * n];
    let (mut a, mut b, mut c) = (out(), out(), out());
    let kernels = move || {
        let vector = &mut a[..STATES * n];
        let result = match quantity {
            Quantity::InverseDynamics => batch.inverse_dynamics(theta, dtheta, x, &environment, vector),
            Quantity::MassMatrix => batch.mass_matrix(theta, &mut a),
            Quantity::ForwardDynamics => batch.forward_dynamics(theta, dtheta, x, &environment, vector),
            _ => batch.inverse_dynamics_derivatives(theta, dtheta, x, &environment, &mut a, &mut b, &mut c),
        };
        black_box(result).expect("sound states");
    };
    let (mut a, mut b, mut c) = (out(), out(), out());
    let machine = move || {
        let vector = &mut a[..STATES * n];
        let result = match quantity {
            Quantity::InverseDynamics => robot.inverse_dynamics_batch(theta, dtheta, x, vector),
            Quantity::MassMatrix => robot.mass_matrix_batch(theta, &mut a),
            Quantity::ForwardDynamics => robot.forward_dynamics_batch(theta, dtheta, x, vector),
            _ => robot.inverse_dynamics_derivatives_batch(theta, dtheta, x, &mut a, &mut b, &mut c),
        };
        black_box(result).expect("sound states");
    };
    [Box::new(kernels), Box::new(machine)]
}

/// Machine code alone, on one block that is already in its place.
fn block<'r>(kernel: &'r Kernel, inputs: &'r [Vec<f64>], outputs: &'r mut [Vec<f64>]) -> Run<'r> {
    let lanes = kernel.shape().lanes();
    Box::new(move || {
        let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        let mut outputs: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        for _ in 0..STATES / lanes {
            kernel.call(black_box(&inputs), black_box(&mut outputs), &mut vec![0.0; lanes]);
        }
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = ["panda", "ur5", "anymal"].map(String::from).to_vec();
    }
    println!(
        "robot, quantity: native | machine code 1 | batch, rows | machine code, rows | machine code, block (ns a state); record + compile"
    );
    for name in names {
        let model = robot(&name)?;
        let (n, nq) = (model.n(), model.nq());
        let batch = Batch::new(&model).with_threads(1)?;
        let lanes = if batch.lanes() == 8 { Shape::EightF64 } else { Shape::FourF64 };
        let mut theta = numbers(STATES * nq, 3.0, 1);
        if model.is_floating() {
            theta.chunks_exact_mut(nq).for_each(|q| q[..4].copy_from_slice(&[0.5, -0.5, 0.5, 0.5]));
        }
        let (dtheta, x) = (numbers(STATES * n, 2.0, 2), numbers(STATES * n, 5.0, 3));
        let states = [&theta[..], &dtheta, &x];
        for quantity in [
            Quantity::InverseDynamics,
            Quantity::MassMatrix,
            Quantity::ForwardDynamics,
            Quantity::InverseDynamicsDerivatives,
        ] {
            let robot = compile(&model, &[quantity])?.with_threads(1)?;
            let program = quantity.record(&model, LeftOpen::default());
            let mut compile_time = f64::INFINITY;
            for _ in 0..20 {
                let start = Instant::now();
                black_box(Kernel::new(&quantity.record(&model, LeftOpen::default()), Shape::OneF64).is_ok());
                compile_time = compile_time.min(start.elapsed().as_secs_f64());
            }
            let kernel = Kernel::new(&program, lanes);
            let l = lanes.lanes();
            let inputs: Vec<_> = program.inputs().iter().map(|input| numbers(input.length * l, 2.0, 4)).collect();
            let mut outputs: Vec<_> =
                program.outputs().iter().map(|output| vec![0.0; output.values.len() * l]).collect();
            let [a, b] = at_one_state(&model, &robot, quantity, states);
            let [c, d] = at_many_states(&batch, &robot, quantity, states);
            let mut runs = vec![a, b, c, d];
            if let Ok(kernel) = &kernel {
                runs.push(block(kernel, &inputs, &mut outputs));
            }
            let mut least = [f64::INFINITY; 5];
            for _ in 0..ROUNDS {
                for (run, least) in runs.iter_mut().zip(&mut least) {
                    let start = Instant::now();
                    run();
                    *least = least.min(start.elapsed().as_secs_f64() * 1e9 / STATES as f64);
                }
            }
            let [native, one, rows, machine_rows, block] = least;
            println!(
                "{name}, {}: {native:.0} | {one:.0} ({:.1} x) | {rows:.1} | {machine_rows:.1} ({:.1} x) | {block:.1}; {:.2} ms; {}; {}",
                quantity.name(),
                native / one,
                rows / machine_rows,
                compile_time * 1e3,
                robot.engine(quantity),
                robot.batch_engine(quantity),
            );
        }
    }
    Ok(())
}
