//! Machine code of every shape that this processor runs, compared with the interpreter.
#![allow(missing_docs)]

use crate::common;

use common::{error, inputs, quantities, robots, state, tolerance};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi::random::Random;
use mozzi::scalar::Float as Number;
use mozzi_engine::{Arguments, Form, Kernel, Program, Refusal, Shape, record, record_quantity};

/// The outputs of each lane, and the sums of squares, for one state in each lane.
fn run<S: Number>(kernel: &Kernel, program: &Program, states: &[Vec<Vec<S>>]) -> (Vec<Vec<Vec<S>>>, Vec<S>) {
    let lanes = kernel.shape().lanes();
    let nan = S::from_f64(f64::NAN);
    let blocks: Vec<Vec<S>> = program
        .inputs()
        .iter()
        .enumerate()
        .map(|(array, input)| {
            (0..input.length).flat_map(|k| states[..lanes].iter().map(move |state| state[array][k])).collect()
        })
        .collect();
    let inputs: Vec<&[S]> = blocks.iter().map(Vec::as_slice).collect();
    let mut outputs: Vec<Vec<S>> =
        program.outputs().iter().map(|output| vec![nan; output.values.len() * lanes]).collect();
    let mut squares = vec![nan; lanes];
    kernel.call(&inputs, &mut outputs.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>(), &mut squares);
    let of_lane = |lane: usize| outputs.iter().map(|x| x.iter().skip(lane).step_by(lanes).copied().collect()).collect();
    ((0..lanes).map(of_lane).collect(), squares)
}

/// The state of row k: the states of a block, in another order in each.
fn state_of_row(k: usize, lanes: usize) -> usize {
    (k + k / lanes) % lanes
}

/// As [`run`], by code in the form of rows: three registers of states in one call.
fn run_rows<S: Number>(kernel: &Kernel, program: &Program, states: &[Vec<Vec<S>>]) -> (Vec<Vec<Vec<S>>>, Vec<S>) {
    const RUNS: usize = 3;
    let nan = S::from_f64(f64::NAN);
    let lanes = kernel.shape().lanes();
    let count = RUNS * lanes;
    let mut extents = kernel.extents().iter();
    let tables: Vec<Vec<S>> = program
        .inputs()
        .iter()
        .zip(extents.by_ref())
        .enumerate()
        .map(|(array, (_, extent))| {
            let mut table: Vec<S> = (0..count).flat_map(|k| states[state_of_row(k, lanes)][array].clone()).collect();
            table.resize(extent.of(RUNS), nan);
            table
        })
        .collect();
    let inputs: Vec<&[S]> = tables.iter().map(Vec::as_slice).collect();
    let mut outputs: Vec<Vec<S>> =
        program.outputs().iter().zip(extents).map(|(_, extent)| vec![nan; extent.of(RUNS)]).collect();
    let mut squares = vec![nan; count];
    kernel.run(RUNS, &inputs, &mut outputs.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>(), &mut squares);
    let widths = || program.outputs().iter().map(|output| output.values.len());
    let of_state = |k: usize| outputs.iter().zip(widths()).map(|(x, width)| x[k * width..][..width].to_vec()).collect();
    if kernel.shape().instruction_set().starts_with("avx512") {
        let rows = |width: usize| count * width;
        assert!(outputs.iter().zip(widths()).all(|(x, width)| x.len() == rows(width)), "nothing beyond the rows");
    }
    ((0..count).map(of_state).collect(), squares)
}

fn states<S: Number>(model: &Model, query: Query, round: u64) -> Vec<Vec<Vec<S>>> {
    let rounded = |x: &[f64]| x.iter().map(|&x| S::from_f64(x)).collect();
    let of = |seed| inputs(query, &state(model, 16 * round + seed)).into_iter().map(rounded).collect();
    (0..16).map(of).collect()
}

/// The largest normalised error of a program on states, compared with the interpreter in `f64`.
fn worst<S: Number + Into<f64>>(kernel: &Kernel, program: &Program, states: &[Vec<Vec<S>>]) -> f64 {
    let (found, squares) = match kernel.form() {
        Form::Blocks => run(kernel, program, states),
        Form::Rows => run_rows(kernel, program, states),
    };
    let mut worst: f64 = 0.0;
    for (k, (found, squares)) in found.iter().zip(squares).enumerate() {
        let state = &states[state_of_row(k, kernel.shape().lanes())];
        assert!(kernel.is_exact(squares));
        let exact: Vec<Vec<f64>> = state.iter().map(|x| x.iter().map(|&x| x.into()).collect()).collect();
        let expected = program.evaluate(&exact.iter().map(Vec::as_slice).collect::<Vec<_>>());
        for (found, expected) in found.iter().zip(&expected) {
            worst = worst.max(error(&found.iter().map(|&x| x.into()).collect::<Vec<_>>(), expected));
        }
    }
    worst
}

#[test]
fn every_quantity_of_every_robot_in_every_shape() {
    let (mut made, mut refused) = (0, 0);
    for (name, model) in robots() {
        for query in quantities(&model) {
            let program = record_quantity(&model, query, Arguments::default()).expect("its own frame");
            let shapes = Shape::ALL.map(|shape| (shape, Form::Blocks)).into_iter();
            let rows = Shape::ALL.into_iter().filter(|shape| shape.lanes() > 1).map(|shape| (shape, Form::Rows));
            for (shape, form) in shapes.chain(rows) {
                let kernel = match Kernel::condensing(&program, shape, form, usize::MAX) {
                    Ok(kernel) => kernel,
                    Err(refusal) => {
                        assert!(matches!(refusal, Refusal::Processor | Refusal::Long), "{refusal}");
                        refused += 1;
                        continue;
                    }
                };
                made += 1;
                let error = match shape.is_f64() {
                    true => worst::<f64>(&kernel, &program, &states(&model, query, 1)),
                    false => worst::<f32>(&kernel, &program, &states(&model, query, 1)) * 2e-9,
                };
                assert!(error < tolerance(query), "{name}, {}, {shape:?}, {form:?}: {error:e}", query.name());
            }
        }
    }
    println!("{made} made, {refused} refused");
}

#[test]
fn sines_and_cosines_are_those_of_the_library() {
    let program = record("sin_cos", &[("x", 2)], |x| {
        let (sin, cos) = mozzi::Scalar::sin_cos(x[0][0]);
        vec![("y", vec![sin, cos, mozzi::Scalar::sgn(x[0][1])])]
    })
    .expect("short");
    let mut random = Random(3);
    for shape in Shape::ALL.into_iter().filter(|shape| shape.is_supported()) {
        let kernel = Kernel::new(&program, shape).expect("a small program");
        let mut worst: f64 = 0.0;
        for k in 0..20_000 {
            let largest = if shape.is_f64() { 1e6 } else { 8192.0 };
            let size = [1.6, 100.0, largest][k % 3];
            let angles: Vec<f64> = (0..16)
                .map(|_| {
                    if k % 4 == 0 {
                        std::f64::consts::FRAC_PI_2 * (size * random.next()).trunc() / 2.0
                    } else {
                        size * random.next()
                    }
                })
                .map(|x| if shape.is_f64() { x } else { f64::from(x as f32) })
                .collect();
            let mut check = |lane: usize, [sin, cos]: [f64; 2]| {
                let (s, c) = angles[lane].sin_cos();
                for (found, expected) in [(sin, s), (cos, c)] {
                    let digits = if shape.is_f64() { 52 } else { 23 };
                    let place = expected.abs().max(if shape.is_f64() { f64::MIN_POSITIVE } else { 1e-3 });
                    let ulp = 2.0_f64.powi(place.log2().floor() as i32 - digits);
                    worst = if found == expected { worst } else { worst.max((found - expected).abs() / ulp) };
                }
            };
            if shape.is_f64() {
                let states: Vec<_> = angles.iter().map(|&x| vec![vec![x, 0.0]]).collect();
                let (found, _) = run(&kernel, &program, &states);
                found.iter().enumerate().for_each(|(lane, y)| check(lane, [y[0][0], y[0][1]]));
            } else {
                let states: Vec<_> = angles.iter().map(|&x| vec![vec![x as f32, 0.0]]).collect();
                let (found, _) = run(&kernel, &program, &states);
                found.iter().enumerate().for_each(|(lane, y)| check(lane, [y[0][0].into(), y[0][1].into()]));
            }
        }
        println!("{shape:?}: {worst:.2} ulp");
        assert!(worst <= if shape.is_f64() { 1.0 } else { 1.5 }, "{shape:?}: {worst} ulp");
        // sgn of special numbers, and invalid angles
        let numbers =
            [0.0, -0.0, 5e-324, -5e-324, 1e-45, 1e300, -1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 2.5, -7.0];
        for x in numbers {
            let small = if shape.is_f64() { 0.3 } else { 0.3_f32.into() };
            let (sgn, squares) = if shape.is_f64() {
                let (y, squares) = run(&kernel, &program, &vec![vec![vec![small, x]]; 16]);
                (y[0][0][2], squares[0])
            } else {
                let (y, squares) = run(&kernel, &program, &vec![vec![vec![small as f32, x as f32]]; 16]);
                (y[0][0][2].into(), squares[0].into())
            };
            let x = if shape.is_f64() { x } else { f64::from(x as f32) };
            let expected = mozzi::Scalar::sgn(x);
            assert!(sgn == expected || sgn.is_nan() && expected.is_nan(), "{shape:?}: sgn {x:e} is {sgn}");
            assert!((squares - small * small).abs() < 1e-7);
        }
    }
}

#[test]
fn angles_beyond_the_reduction_are_told() {
    let program = record("sin", &[("x", 1)], |x| vec![("y", vec![mozzi::Scalar::sin_cos(x[0][0]).0])]).expect("short");
    for shape in [Shape::OneF64, Shape::FourF64, Shape::EightF64].into_iter().filter(|shape| shape.is_supported()) {
        let kernel = Kernel::new(&program, shape).expect("a small program");
        let angles = [1.0, 0.99e6, 1.01e6, f64::NAN, f64::INFINITY, -2e6, 1e200, 0.0];
        let states: Vec<_> = (0..16).map(|k| vec![vec![angles[k % shape.lanes().min(8)]]]).collect();
        let (_, squares) = run(&kernel, &program, &states);
        for (squares, state) in squares.iter().zip(&states) {
            assert_eq!(kernel.is_exact(*squares), state[0][0].abs() < 1e6, "{state:?}");
        }
    }
}

#[test]
fn what_no_machine_code_is_made_of() {
    let tanh = record("tanh", &[("x", 1)], |x| vec![("y", vec![mozzi::Scalar::tanh(x[0][0])])]).expect("short");
    let names: Vec<String> = (0..12).map(|k| format!("x{k}")).collect();
    let arrays: Vec<(&str, usize)> = names.iter().map(|name| (name.as_str(), 1)).collect();
    let many =
        record("many", &arrays, |x| vec![("y", vec![x.iter().fold(x[0][0], |sum, x| sum + x[0])])]).expect("short");
    let long = record("long", &[("x", 300)], |x| {
        let sum = (0..400_000).fold(x[0][0], |sum, k| sum * x[0][k % 300] + x[0][k * 7 % 300]);
        vec![("y", vec![sum])]
    })
    .expect("short");
    for shape in Shape::ALL.into_iter().filter(|shape| shape.is_supported()) {
        assert_eq!(Kernel::new(&tanh, shape).err(), Some(Refusal::Program));
        assert_eq!(Kernel::new(&many, shape).err(), Some(Refusal::Program));
        assert_eq!(Kernel::new(&long, shape).err(), Some(Refusal::Long));
    }
}

#[test]
fn rows_of_any_width() {
    let (mut random, lanes) = (Random(8), |shape: Shape| shape.lanes());
    for width in [1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33] {
        // sums with neighbours, a reversed copy, a constant in each square
        let program = record("neighbours", &[("x", width), ("y", 2)], |x| {
            let next = |k: usize| x[0][k] + x[0][(k + 1) % width] * x[1][k % 2];
            let reversed = (0..width).rev().map(|k| if k % 5 == 3 { 0.5.into() } else { x[0][k] });
            vec![("z", (0..width).map(next).collect()), ("w", reversed.collect()), ("s", vec![x[0][0]])]
        })
        .expect("short");
        for shape in Shape::ALL.into_iter().filter(|&shape| shape.is_supported() && lanes(shape) > 1) {
            let kernel = Kernel::condensing(&program, shape, Form::Rows, usize::MAX).expect("a small program");
            let mut number = |_| 2.0 * random.next() - 1.0;
            let states: Vec<Vec<Vec<f64>>> =
                (0..48).map(|_| [width, 2].map(|length| (0..length).map(&mut number).collect()).to_vec()).collect();
            let narrow = |x: &Vec<Vec<f64>>| x.iter().map(|x| x.iter().map(|&x| x as f32).collect()).collect();
            let error = match shape.is_f64() {
                true => worst::<f64>(&kernel, &program, &states),
                false => worst::<f32>(&kernel, &program, &states.iter().map(narrow).collect::<Vec<_>>()) * 1e-9,
            };
            assert!(error < 1e-15, "{width} columns, {shape:?}: {error:e}");
        }
    }
}

#[test]
#[should_panic(expected = "an input has 22 entries, expected 23")]
fn a_short_table_is_refused() {
    let program = record("copy", &[("x", 1)], |x| vec![("y", vec![x[0][0] + x[0][0]])]).expect("short");
    match Kernel::condensing(&program, Shape::EightF64, Form::Rows, usize::MAX) {
        // two runs of eight rows, and seven numbers beyond the last
        Ok(kernel) => kernel.run(2, &[&[1.0; 22]], &mut [&mut [0.0; 16]], &mut [0.0; 16]),
        Err(refusal) => panic!("an input has 22 entries, expected 23: nothing to test here, {refusal}"),
    }
}

#[test]
#[should_panic(expected = "an output has 0 entries, expected 1")]
fn a_short_output_is_refused() {
    let program = record("copy", &[("x", 1)], |x| vec![("y", vec![x[0][0]])]).expect("short");
    match Kernel::new(&program, Shape::OneF64) {
        Ok(kernel) => kernel.call(&[&[1.0]], &mut [&mut []], &mut [0.0]),
        Err(refusal) => panic!("an output has 0 entries, expected 1: nothing to test here, {refusal}"),
    }
}
