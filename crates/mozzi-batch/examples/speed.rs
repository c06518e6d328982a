//! Compares machine code with `mozzi::fast` at one state, with the kernels at many, and with the emitted C compiled by
//! `gcc -O3 -march=native -std=gnu99` if gcc is installed. One interleaved run on one thread; the result is the fastest
//! of many rounds, in nanoseconds for each state.
//!
//! `cargo run --release -p mozzi-batch --example speed [ROBOT …]`

use mozzi::quantities::{ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, Query};
use mozzi::testing::Random;
use mozzi::{Model, fast};
use mozzi_batch::{Batch, Compiled, compile};
use mozzi_codegen::{Arguments, Kernel, Language, Precision, Program, Shape, emit_into, record_quantity};
use std::hint::black_box;
use std::time::Instant;

const STATES: usize = 256;
const ROUNDS: usize = 60;

fn robot(name: &str) -> Result<Model, Box<dyn std::error::Error>> {
    let model = mozzi_urdf::open(name)?.build()?;
    Ok(if name == "panda" { model.with_locked_joints(&[("panda_finger_joint1", 0.0)])? } else { model })
}

type Run<'r> = Box<dyn FnMut() + 'r>;

/// The entries of θ, θ̇ and a third vector that a quantity takes.
fn inputs<'x>(query: Query, tables: [&'x [f64]; 3]) -> Vec<&'x [f64]> {
    let place = |name| ["theta", "dtheta"].iter().position(|known| *known == name).unwrap_or(2);
    query.declaration().inputs.iter().map(|input| tables[place(input.name)]).collect()
}

/// Arrays of these lengths for this many states.
fn arrays(lengths: impl Iterator<Item = usize>, states: usize) -> Vec<Vec<f64>> {
    lengths.map(|length| vec![0.0; states * length]).collect()
}
fn slices(arrays: &mut [Vec<f64>]) -> Vec<&mut [f64]> {
    arrays.iter_mut().map(Vec::as_mut_slice).collect()
}

/// Computes all states with one call of `run` for each, which fills arrays of these lengths.
fn one_a_call<'r>(
    model: &Model,
    query: Query,
    tables: [&'r [f64]; 3],
    lengths: impl Iterator<Item = usize>,
    mut run: impl FnMut(&[&[f64]], &mut [&mut [f64]]) + 'r,
) -> Run<'r> {
    let widths: Vec<usize> = query.input_lengths(model).collect();
    let at = |k: usize| inputs(query, tables).into_iter().zip(&widths).map(move |(x, width)| &x[k * width..][..*width]);
    let states: Vec<Vec<&[f64]>> = (0..STATES).map(|k| at(k).collect()).collect();
    let mut outputs = arrays(lengths, 1);
    Box::new(move || {
        let mut outputs = slices(&mut outputs);
        for state in &states {
            run(black_box(state), &mut outputs);
            black_box(&mut outputs);
        }
    })
}

fn at_many_states<'r>(batch: &'r Batch, query: Query<'static>, tables: [&'r [f64]; 3]) -> Run<'r> {
    let (inputs, environment) = (inputs(query, tables), batch.model().environment().into());
    let mut outputs = arrays(query.output_lengths(batch.model()), STATES);
    Box::new(move || {
        let result = batch.compute(query, &inputs, &environment, &mut slices(&mut outputs));
        black_box(result).expect("sound states");
    })
}

/// The emitted C's function as gcc compiles it; none without gcc.
fn emitted(model: &Model, query: Query) -> Option<(libloading::Library, String)> {
    let folder = std::env::temp_dir().join(format!("mozzi_speed_{}", std::process::id()));
    emit_into(&folder, model, &[query], Arguments::default(), Language::C, Precision::F64).ok()?;
    let name = &model.description().name;
    let mut gcc = std::process::Command::new("gcc");
    gcc.args(["-O3", "-march=native", "-std=gnu99", "-shared", "-fPIC", "-o"]).arg(folder.join("robot.so"));
    let made = gcc.arg(folder.join(format!("{name}.c"))).arg("-lm").status().is_ok_and(|status| status.success());
    // SAFETY: the library is the emitted code, and runs nothing when it is loaded.
    let library = made.then(|| unsafe { libloading::Library::new(folder.join("robot.so")) }.ok());
    let _ = std::fs::remove_dir_all(&folder); // it stays loaded
    Some((library??, format!("{name}_{}", query.name())))
}

/// Calls it at all states, one after the other.
fn at_one_state_in_c<'r>(
    model: &Model,
    (library, name): &'r (libloading::Library, String),
    (query, program): (Query, &Program),
    tables: [&'r [f64]; 3],
) -> Option<Run<'r>> {
    let lengths = || program.outputs().iter().map(|output| output.values.len());
    macro_rules! run {
        ($($x:ident)*, $($y:ident)*) => {{
            type Function = unsafe extern "C" fn($(run!(@type $x, *const f64),)* $(run!(@type $y, *mut f64)),*);
            // SAFETY: the header declares the function of this name with this type.
            let function = *unsafe { library.get::<Function>(name.as_bytes()) }.ok()?;
            one_a_call(model, query, tables, lengths(), move |inputs, outputs| {
                let ([$($x),*], [$($y),*]) = (inputs, outputs) else { return };
                // SAFETY: the arrays have the robot's lengths.
                unsafe { function($($x.as_ptr(),)* $($y.as_mut_ptr()),*) };
            })
        }};
        (@type $x:ident, $T:ty) => { $T };
    }
    Some(match (program.inputs().len(), program.outputs().len()) {
        (1, 1) => run!(a, x),
        (3, 1) => run!(a b c, x),
        (3, 2) => run!(a b c, x y),
        (3, 3) => run!(a b c, x y z),
        _ => return None,
    })
}

/// Times machine code alone, on one block whose columns are already in place.
fn block<'r>(kernel: &'r Kernel, program: &Program) -> Run<'r> {
    let (lanes, mut random) = (kernel.shape().lanes(), Random(4));
    let inputs: Vec<_> = program.inputs().iter().map(|input| random.vector(input.length * lanes, 2.0)).collect();
    let mut outputs = arrays(program.outputs().iter().map(|output| output.values.len()), lanes);
    Box::new(move || {
        let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        let mut outputs = slices(&mut outputs);
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
        let mut random = Random(1);
        let mut theta = random.vector(STATES * nq, 3.0);
        if model.is_floating() {
            theta.chunks_exact_mut(nq).for_each(|q| q[..4].copy_from_slice(&[0.5, -0.5, 0.5, 0.5]));
        }
        let (dtheta, x) = (random.vector(STATES * n, 2.0), random.vector(STATES * n, 5.0));
        let tables = [&theta[..], &dtheta, &x];
        let queries: [Query; 4] =
            [InverseDynamics.into(), MassMatrix.into(), ForwardDynamics.into(), InverseDynamicsDerivatives.into()];
        for query in queries {
            let robot: Compiled = compile(&model, &[query])?.with_threads(1)?;
            let program = record_quantity(&model, query, Arguments::default())?;
            let mut compile_time = f64::INFINITY;
            for _ in 0..20 {
                let start = Instant::now();
                let program = record_quantity(&model, query, Arguments::default())?;
                black_box(Kernel::new(&program, Shape::OneF64).is_ok());
                compile_time = compile_time.min(start.elapsed().as_secs_f64());
            }
            let kernel = Kernel::new(&program, lanes);
            let in_c = emitted(&model, query);
            let (mut workspace, environment) = (fast::Workspace::new(&model), model.environment());
            let native = one_a_call(&model, query, tables, query.output_lengths(&model), |inputs, outputs| {
                fast::evaluate(&query, &model, inputs, &environment, &mut workspace, outputs);
            });
            let machine = one_a_call(&model, query, tables, query.output_lengths(&model), |inputs, outputs| {
                robot.evaluate(query, inputs, outputs);
            });
            let in_c = in_c.as_ref().and_then(|found| at_one_state_in_c(&model, found, (query, &program), tables));
            let (rows, machine_rows) =
                (at_many_states(&batch, query, tables), at_many_states(robot.batch(), query, tables));
            let block = kernel.as_ref().ok().map(|kernel| block(kernel, &program));
            let mut runs = [Some(native), Some(machine), in_c, Some(rows), Some(machine_rows), block];
            let mut least = [f64::INFINITY; 6];
            for _ in 0..ROUNDS {
                for (run, least) in runs.iter_mut().zip(&mut least) {
                    let Some(run) = run else { continue };
                    let start = Instant::now();
                    run();
                    *least = least.min(start.elapsed().as_secs_f64() * 1e9 / STATES as f64);
                }
            }
            let [native, one, in_c, rows, machine_rows, block] = least;
            let in_c = if in_c.is_finite() { format!("{in_c:.0}") } else { "–".into() };
            println!(
                "{name}, {}: {native:.0} | {one:.0} ({:.1} x) | {in_c} | {rows:.1} | {machine_rows:.1} ({:.1} x) | {block:.1}; {:.2} ms; {}; {}",
                query.name(),
                native / one,
                rows / machine_rows,
                compile_time * 1e3,
                robot.engine(query),
                robot.batch_engine(query),
            );
        }
    }
    Ok(())
}
