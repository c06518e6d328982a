//! Machine code beside `mozzi::fast` at one state and `mozzi-batch` at many, and beside the emitted C by `gcc -O3 -march=native -std=gnu99`
//! where there is a gcc, in one interleaved run on one thread: the least of many rounds, in nanoseconds a state.
//!
//! `cargo run --release -p mozzi-codegen --example speed [ROBOT …]`

use mozzi::{Model, fast};
use mozzi_batch::Batch;
use mozzi_codegen::{Arguments, Compiled, Kernel, Language, Precision, Quantity, Shape, compile, emit_into};
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
    let (mut w, mut out, mut out3) = (fast::Workspace::new(model), vec![0.0; n * n], vec![0.0; 3 * n * n]);
    let kernels = move || {
        for k in 0..STATES {
            let (q, v, a) = (&theta[nq * k..][..nq], &dtheta[n * k..][..n], &x[n * k..][..n]);
            let (first, others) = out3.split_at_mut(n * n);
            let three = [first, &mut others[..n * n], &mut out[..]];
            match quantity {
                Quantity::InverseDynamics => {
                    fast::inverse_dynamics(model, q, v, a, &environment, &mut w, &mut out[..n])
                }
                Quantity::MassMatrix => fast::mass_matrix(model, q, &mut w, &mut out),
                Quantity::ForwardDynamics => {
                    fast::forward_dynamics(model, q, v, a, &environment, &mut w, &mut out[..n])
                }
                _ => fast::inverse_dynamics_derivatives(model, q, v, a, &environment, &mut w, three),
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

/// The emitted C's function as gcc compiles it; none without a gcc.
fn emitted(model: &Model, quantity: Quantity) -> Option<(libloading::Library, String)> {
    let folder = std::env::temp_dir().join(format!("mozzi_speed_{}", std::process::id()));
    emit_into(&folder, model, &[quantity], Arguments::default(), Language::C, Precision::F64).ok()?;
    let name = &model.description().name;
    let mut gcc = std::process::Command::new("gcc");
    gcc.args(["-O3", "-march=native", "-std=gnu99", "-shared", "-fPIC", "-o"]).arg(folder.join("robot.so"));
    let made = gcc.arg(folder.join(format!("{name}.c"))).arg("-lm").status().is_ok_and(|status| status.success());
    // SAFETY: the library is what was emitted, and does nothing when it is loaded.
    let library = made.then(|| unsafe { libloading::Library::new(folder.join("robot.so")) }.ok());
    let _ = std::fs::remove_dir_all(&folder); // it stays loaded
    Some((library??, format!("{name}_{}", quantity.name())))
}

/// It at all states, one a call.
fn at_one_state_in_c<'r>(
    model: &'r Model,
    (library, name): &'r (libloading::Library, String),
    quantity: Quantity,
    [theta, dtheta, x]: [&'r [f64]; 3],
) -> Option<Run<'r>> {
    type Array = *const f64;
    type Out = *mut f64;
    let (n, nq) = (model.n(), model.nq());
    let [mut a, mut b, mut c] = [(); 3].map(|()| vec![0.0; n * n]);
    macro_rules! run {
        ($f:ty, |$g:ident, $q:ident, $v:ident, $w:ident| $call:expr) => {{
            // SAFETY: the header says so of the function of this name.
            let $g = *unsafe { library.get::<$f>(name.as_bytes()) }.ok()?;
            Box::new(move || {
                for k in 0..STATES {
                    let state = black_box([&theta[nq * k..][..nq], &dtheta[n * k..][..n], &x[n * k..][..n]]);
                    let [$q, $v, $w] = state.map(<[f64]>::as_ptr);
                    let _ = ($v, $w);
                    // SAFETY: arrays are as long as the robot's.
                    unsafe { $call };
                    black_box((&mut a, &mut b, &mut c));
                }
            }) as Run
        }};
    }
    Some(match quantity {
        Quantity::InverseDynamics => {
            run!(unsafe extern "C" fn(Array, Array, Array, Out), |g, q, v, w| g(q, v, w, a.as_mut_ptr()))
        }
        Quantity::MassMatrix => run!(unsafe extern "C" fn(Array, Out), |g, q, v, w| g(q, a.as_mut_ptr())),
        Quantity::ForwardDynamics => run!(unsafe extern "C" fn(Array, Array, Array, Out, Out), |g, q, v, w| g(
            q,
            v,
            w,
            a.as_mut_ptr(),
            b.as_mut_ptr()
        )),
        _ => run!(unsafe extern "C" fn(Array, Array, Array, Out, Out, Out), |g, q, v, w| g(
            q,
            v,
            w,
            a.as_mut_ptr(),
            b.as_mut_ptr(),
            c.as_mut_ptr()
        )),
    })
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
        "robot, quantity: native | machine code 1 | emitted C by gcc | batch, rows | machine code, rows | machine code, block (ns a state); record + compile"
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
            let program = quantity.record(&model, Arguments::default());
            let mut compile_time = f64::INFINITY;
            for _ in 0..20 {
                let start = Instant::now();
                black_box(Kernel::new(&quantity.record(&model, Arguments::default()), Shape::OneF64).is_ok());
                compile_time = compile_time.min(start.elapsed().as_secs_f64());
            }
            let kernel = Kernel::new(&program, lanes);
            let l = lanes.lanes();
            let inputs: Vec<_> = program.inputs().iter().map(|input| numbers(input.length * l, 2.0, 4)).collect();
            let mut outputs: Vec<_> =
                program.outputs().iter().map(|output| vec![0.0; output.values.len() * l]).collect();
            let in_c = emitted(&model, quantity);
            let [a, b] = at_one_state(&model, &robot, quantity, states);
            let [c, d] = at_many_states(&batch, &robot, quantity, states);
            let mut runs = vec![a, b, c, d];
            if let Ok(kernel) = &kernel {
                runs.push(block(kernel, &inputs, &mut outputs));
            }
            let c = in_c.as_ref().and_then(|function| at_one_state_in_c(&model, function, quantity, states));
            let is_in_c = c.is_some();
            runs.insert(2, c.unwrap_or_else(|| Box::new(|| ())));
            let mut least = [f64::INFINITY; 6];
            for _ in 0..ROUNDS {
                for (run, least) in runs.iter_mut().zip(&mut least) {
                    let start = Instant::now();
                    run();
                    *least = least.min(start.elapsed().as_secs_f64() * 1e9 / STATES as f64);
                }
            }
            let [native, one, in_c, rows, machine_rows, block] = least;
            let in_c = if is_in_c { format!("{in_c:.0}") } else { "–".into() };
            println!(
                "{name}, {}: {native:.0} | {one:.0} ({:.1} x) | {in_c} | {rows:.1} | {machine_rows:.1} ({:.1} x) | {block:.1}; {:.2} ms; {}; {}",
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
