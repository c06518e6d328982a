//! Every quantity of the list, computed in every possible way, compared with a second, independent computation: on
//! plain and fused `f64`, `f32`, dual numbers, memory full of NaN, every register of the machine in rows, recorded
//! programs interpreted, as machine code at one state and at many, as C; on fixed and floating bases, with and without
//! mimic joints, friction, base motion, wrenches on two frames.
#![allow(missing_docs)]

mod allocations;
mod emitted;

use crate::ways::ways;

use allocations::allocations;
use mozzi::model::description::{Closure, Constraint};
use mozzi::quantities::*;
use mozzi::testing::{closed, floating_mixed_tree, floating_tree, grippers, mixed_tree, state, tree, twist, wrench};
use mozzi::{Dual, Environment, Error, FrameId, Freedom, Model, Scalar, Task, TaskFrame, Vec3, Wrench, fast};
use mozzi_engine::{Arguments, Batch, BatchEnvironment, Compiled, Number, compile, record_quantity};
use mozzi_testing::{Given, SecondWay, second_way_of_f64};

/// Fixed and floating, with and without mimic joints, with balls and free joints, one joint alone, none.
fn robots() -> Vec<(&'static str, Model)> {
    vec![
        ("fixed", tree(1, 7, 0)),
        ("fixed, mimic joints", tree(2, 8, 2)),
        ("floating", floating_tree(3, 5, 0)),
        ("floating, mimic joints", floating_tree(4, 6, 2)),
        ("floating, joints that move together", grippers(&floating_tree(12, 7, 0))),
        ("balls and a free joint, mimic joints", mixed_tree(4, 5, 1)),
        ("floating, balls and a free joint", floating_mixed_tree(8, 3, 0)),
        ("a loop and a rope", closed_at_a_state(&tree(9, 8, 0), &[Closure::Point, Closure::Distance(0.6)])),
        (
            "floating, a wheel and a weld",
            closed_at_a_state(&floating_tree(7, 9, 1), &[Closure::Rolling(0.3), Closure::Weld]),
        ),
        ("balls, a hinge and a cam", with_a_cam(&closed_at_a_state(&mixed_tree(6, 8, 0), &[Closure::Hinge]))),
        ("one joint", tree(5, 1, 0)),
        ("no joints", tree(6, 0, 0)),
    ]
}

/// Robots with independent constraints that are satisfied at one state but not at the others: the equations are the
/// same.
fn closed_at_a_state(model: &Model, closures: &[Closure]) -> Model {
    let theta = &state(model, 1)[0];
    let found = (0..100).map(|seed| closed(model, theta, closures, seed));
    found.into_iter().find(are_independent).expect("one of a hundred")
}

fn are_independent(model: &Model) -> bool {
    (0..5).all(|seed| model.constraint_rank(&state(model, seed)[0]).expect("lengths").redundant.is_empty())
}

fn with_a_cam(model: &Model) -> Model {
    let one_axis: Vec<String> = (model.joints().zip(model.places()))
        .filter(|(_, place)| place.freedom == Freedom::One)
        .map(|(joint, _)| joint.name.clone())
        .collect();
    let cam = |k: usize| {
        let cam = Constraint::joint("cam", &one_axis[0], &one_axis[k], [0.1, 0.5, -0.2, 0.1, 0.05]);
        model.with_constraints([cam]).expect("joints of one axis")
    };
    (1..one_axis.len()).map(cam).find(are_independent).expect("another joint")
}

/// A robot at a few states, in an environment that uses every feature.
struct Case<'a> {
    name: &'a str,
    model: &'a Model,
    frame: FrameId,
    states: Vec<[Vec<f64>; 5]>,
    applied: [(FrameId, Wrench); 2],
    rows: Vec<usize>,
}

impl Case<'_> {
    fn query(&self, query: Query<'static>) -> Query<'_> {
        match query.declaration().of {
            Of::Robot => query,
            Of::Frame => query.of(self.frame),
            Of::Task => query.of_task(Task { frame: self.frame, coordinates: TaskFrame::Body, rows: &self.rows }),
            Of::Point => query.about(Vec3([0.3, -0.2, 0.5])),
        }
    }

    fn environment(&self) -> Environment<'_> {
        Environment {
            gravity: Vec3([1.0, 2.0, -9.0]),
            base_twist: twist(1),
            base_acceleration: twist(2),
            applied: &self.applied,
        }
    }

    fn inputs<'s>(&self, query: Query, state: &'s [Vec<f64>; 5]) -> Vec<&'s [f64]> {
        let which = |name: &str| match name {
            "theta" => 0,
            "dtheta" => 1,
            "x" => 3,
            "w" => 4,
            _ => 2,
        };
        query.declaration().inputs.iter().map(|input| &state[which(input.name)][..]).collect()
    }
}

/// Asserts |found − expected| within a bound, relative to the largest entry of each output.
#[track_caller]
fn close(what: &str, found: &[Vec<f64>], expected: &[Vec<f64>], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}: outputs");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.len(), expected.len(), "{what}: numbers");
        let size = expected.iter().chain(found).fold(1e-3_f64, |m, x| m.max(x.abs()));
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= tolerance * size, "{what}: {f} instead of {e}, of {size}");
        }
    }
}

/// The outputs on any number type, in memory full of NaN.
fn on<S: Scalar + From<C> + Into<f64> + 'static, C: Scalar + 'static>(
    query: Query,
    model: &Model,
    constants: &Model<C>,
    inputs: &[&[f64]],
    environment: &Environment,
) -> Vec<Vec<f64>> {
    let number = |x: f64| S::from_f64(x);
    let inputs: Vec<Vec<S>> = inputs.iter().map(|x| x.iter().map(|&x| number(x)).collect()).collect();
    let inputs: Vec<&[S]> = inputs.iter().map(Vec::as_slice).collect();
    let mut applied = Vec::new();
    let environment = environment.map(number, &mut applied);
    let mut memory = Memory::new(constants);
    let mut found = Vec::new();
    for _ in 0..2 {
        let mut outputs: Vec<Vec<S>> =
            query.output_lengths(model).map(|length| vec![number(f64::NAN); length]).collect();
        let mut slices: Vec<&mut [S]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        query.evaluate(constants, &inputs, &environment, &mut memory, &mut slices);
        found.push(outputs.iter().map(|x| x.iter().map(|&x| x.into()).collect()).collect::<Vec<Vec<f64>>>());
        memory.fill_nan();
    }
    assert!(found[0].iter().flatten().all(|x| !x.is_nan()), "{}: NaN", query.name());
    let bits = |x: &Vec<Vec<f64>>| x.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&found[0]), bits(&found[1]), "{}: depends on what its memory held", query.name());
    found.swap_remove(0)
}

fn on_duals(case: &Case, query: Query, inputs: &[&[f64]]) -> Vec<Vec<f64>> {
    let dual = case.model.map(Dual::constant);
    let inputs: Vec<Vec<Dual>> = inputs.iter().map(|x| Dual::constants(x)).collect();
    let mut applied = Vec::new();
    let environment = case.environment().map(Dual::constant, &mut applied);
    let mut outputs: Vec<Vec<Dual>> =
        query.output_lengths(case.model).map(|length| vec![Dual::zero(); length]).collect();
    let mut slices: Vec<&mut [Dual]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let inputs: Vec<&[Dual]> = inputs.iter().map(Vec::as_slice).collect();
    query.evaluate(&dual, &inputs, &environment, &mut Memory::new(&dual), &mut slices);
    outputs.iter().map(|x| x.iter().map(|&x| x.value).collect()).collect()
}

/// All states in one call, and each state's outputs.
fn in_arrays<T: Number>(
    batch: &Batch<T>,
    query: Query,
    tables: &[Vec<Vec<f64>>],
    environment: &BatchEnvironment<T>,
) -> Vec<Vec<Vec<f64>>> {
    let table =
        |k: usize| -> Vec<T> { tables.iter().flat_map(|inputs| inputs[k].iter().map(|&x| T::from_f64(x))).collect() };
    let inputs: Vec<Vec<T>> = (0..tables[0].len()).map(table).collect();
    let inputs: Vec<&[T]> = inputs.iter().map(Vec::as_slice).collect();
    let lengths: Vec<usize> = query.output_lengths(batch.model()).collect();
    let nan = T::from_f64(f64::NAN);
    let mut outputs: Vec<Vec<T>> = lengths.iter().map(|length| vec![nan; length * tables.len()]).collect();
    let mut slices: Vec<&mut [T]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    batch.compute(query, &inputs, environment, &mut slices).unwrap_or_else(|error| panic!("{}: {error}", query.name()));
    let of = |k: usize| -> Vec<Vec<f64>> {
        let part = |(x, &length): (&Vec<T>, &usize)| x[k * length..][..length].iter().map(|&x| x.into()).collect();
        outputs.iter().zip(&lengths).map(part).collect()
    };
    (0..tables.len()).map(of).collect()
}

fn conform<Q: SecondWay>(case: &Case) {
    let query = case.query(Query::at(place::<Q>()));
    let (model, environment) = (case.model, case.environment());
    let what = |way: &str| format!("{} of {}, {way}", query.name(), case.name);
    let (wide, tolerance) = (1e-9_f64.max(Q::TOLERANCE), Q::TOLERANCE);
    let inputs: Vec<Vec<&[f64]>> = case.states.iter().map(|state| case.inputs(query, state)).collect();
    let given = |inputs: &[&[f64]]| -> Vec<Vec<f64>> {
        if query.output_lengths(model).all(|length| length == 0) {
            return vec![Vec::new(); query.declaration().outputs.len()];
        }
        let (robot, of) = (model.description(), query.subject);
        second_way_of_f64(query.index(), Given { robot, model, of, inputs, environment: &environment })
    };

    if model.n() == 0
        && let Err(error) = model.compute(query, &inputs[0], &environment)
    {
        assert!(
            matches!(error, Error::NoMass { .. } | Error::SingularTask { .. }),
            "{}: {error}",
            what("nothing moves")
        );
        return;
    }
    let expected: Vec<Vec<Vec<f64>>> = inputs.iter().map(|inputs| given(inputs)).collect();

    // one state
    let mut workspace = fast::Workspace::new(model);
    for (inputs, expected) in inputs.iter().zip(&expected) {
        let plain = model.compute(query, inputs, &environment).expect("regular");
        close(&what("plain"), &plain, expected, tolerance);
        close(&what("with NaN in memory"), &on::<f64, f64>(query, model, model, inputs, &environment), &plain, 0.0);
        close(&what("duals"), &on_duals(case, query, inputs), &plain, wide);
        let mut outputs: Vec<Vec<f64>> = plain.iter().map(|x| vec![f64::NAN; x.len()]).collect();
        let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        fast::evaluate(&query, model, inputs, &environment, &mut workspace, &mut slices);
        let before = allocations();
        fast::evaluate(&query, model, inputs, &environment, &mut workspace, &mut slices);
        assert_eq!(allocations() - before, 0, "{}", what("allocations"));
        close(&what("fused"), &outputs, &plain, wide);
    }

    // arrays, with a wrench, gravity and base motion for all and a wrench for each state
    let tables: Vec<Vec<Vec<f64>>> = inputs.iter().map(|inputs| inputs.iter().map(|x| x.to_vec()).collect()).collect();
    for parameters in [false, true] {
        arrays::<f64>(case, query, &tables, parameters, wide);
        if !query.declaration().divides {
            arrays::<f32>(case, query, &tables, parameters, 2e-3);
        }
    }

    // the robot's own environment: programs, machine code
    let own = model.environment();
    let program = record_quantity(model, query, Arguments::default()).expect("its own frames");
    let compiled = compile(model, &[query]).expect("its own frames");
    let expected: Vec<Vec<Vec<f64>>> =
        inputs.iter().map(|inputs| model.compute(query, inputs, &own).expect("regular")).collect();
    for (inputs, expected) in inputs.iter().zip(&expected) {
        let mut found = program.evaluate(inputs);
        found.truncate(expected.len());
        close(&what("program"), &found, expected, wide);
        one_by_machine_code(&what("machine code"), &compiled, query, inputs, expected, wide);
    }
    for (_, batch) in ways::<f64>(model, &[query]) {
        for (found, expected) in in_arrays(&batch, query, &tables, &own.into()).iter().zip(&expected) {
            close(&what(&batch.engine(query).to_string()), found, expected, wide);
        }
    }
}

fn one_by_machine_code(
    what: &str,
    compiled: &Compiled,
    query: Query,
    inputs: &[&[f64]],
    expected: &[Vec<f64>],
    tolerance: f64,
) {
    let mut outputs: Vec<Vec<f64>> = expected.iter().map(|x| vec![f64::NAN; x.len()]).collect();
    let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    compiled.evaluate(query, inputs, &mut slices);
    let before = allocations();
    compiled.evaluate(query, inputs, &mut slices);
    assert_eq!(allocations() - before, 0, "{what}: allocations");
    compiled.compute(query, inputs, &mut slices).expect("regular");
    close(what, &outputs, expected, tolerance);
}

/// Wrenches, gravity and, if requested, parameters of each state.
fn arrays<T: Number>(case: &Case, query: Query, tables: &[Vec<Vec<f64>>], with_parameters: bool, tolerance: f64) {
    let (model, count) = (case.model, tables.len());
    let numbers = |x: &[f64]| x.iter().map(|&x| T::from_f64(x)).collect::<Vec<T>>();
    let gravity: Vec<[f64; 3]> = (0..count).map(|k| [1.0 + k as f64, 2.0, -9.0]).collect();
    let wrenches: Vec<[f64; 6]> = (0..count).map(|k| wrench(k as u64).to_array()).collect();
    let parameters: Vec<Vec<f64>> =
        (0..count).map(|k| model.parameters().iter().map(|x| x * (1.0 + 0.1 * k as f64)).collect()).collect();
    let [g, F, pi] = [numbers(gravity.as_flattened()), numbers(wrenches.as_flattened()), numbers(&parameters.concat())];
    let of_frame = [(case.frame, &F[..])];
    let environment = BatchEnvironment {
        environment: case.environment(),
        wrenches: &of_frame,
        gravity: Some(&g),
        parameters: with_parameters.then_some(&pi[..]),
    };
    let (name, size) = (query.name(), size_of::<T>());
    // in machine code, too: as one call of many states would decide
    let shapes = T::SHAPES.into_iter().filter(|shape| shape.is_supported());
    let codes = shapes.map(|shape| {
        let batch = Batch::<T>::of(model).with_shape(shape).expect("supported");
        batch.for_job_of(&[query], &environment, usize::MAX).expect("its own frames")
    });
    for batch in codes.chain([Batch::<T>::of(model).kernels_only()]) {
        let batch = batch.with_threads(1).expect("one");
        let engine = batch.engine_in(query, &environment);
        let way = format!("{name} of {}, {size} bytes a number, parameters {with_parameters}, {engine}", case.name);
        for (k, found) in in_arrays(&batch, query, tables, &environment).iter().enumerate() {
            let applied = [case.applied[0], case.applied[1], (case.frame, Wrench::from_array(wrenches[k]))];
            let one = Environment { gravity: Vec3(gravity[k]), applied: &applied, ..case.environment() };
            let robot = if with_parameters { &model.with_parameters(&parameters[k]) } else { model };
            let inputs: Vec<&[f64]> = tables[k].iter().map(Vec::as_slice).collect();
            let expected = robot.compute(query, &inputs, &one).expect("regular");
            close(&way, found, &expected, tolerance);
        }
    }
}

fn place<Q: Quantity>() -> usize {
    Query::from_quantity::<Q>().index()
}

/// A single row of the frame's twist that at least one joint moves.
fn a_row(model: &Model, frame: FrameId, theta: &[f64]) -> Vec<usize> {
    let J = model.body_jacobian(theta, frame).expect("lengths").matrix();
    let sizes: Vec<f64> = (0..6).map(|row| J.row(row).norm()).collect();
    vec![(0..6).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).expect("six")]
}

#[test]
fn every_quantity_in_every_way() {
    let robots = robots();
    std::thread::scope(|scope| {
        for (name, model) in &robots {
            scope.spawn(move || {
                let frame = model.end_effector().expect("named");
                let states = (0..5).map(|seed| {
                    let ([theta, dtheta, ddtheta], [_, x, _]) = (state(model, seed), state(model, seed + 100));
                    [theta, dtheta, ddtheta, x, twist(seed).to_array().to_vec()]
                });
                let states: Vec<_> = states.collect();
                let rows = a_row(model, frame, &states[0][0]);
                let other = model.frame(if model.n() == 0 { "link0" } else { "link1" }).expect("a link");
                let applied = [(frame, wrench(11)), (other, wrench(12))];
                let case = Case { name, model, frame, states, applied, rows };
                macro_rules! check_all {
                    ($($Q:ident)*) => { $(conform::<$Q>(&case);)* };
                }
                mozzi::quantities!(check_all);
                if model.n() > 0 {
                    emitted::every_quantity_as_c(&case); // C has no empty arrays
                }
            });
        }
    });
}
