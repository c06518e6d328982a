//! Compares machine code with the interpreter on random programs: for `MOZZI_FUZZ_SECONDS` (5 by default) from the seed
//! `MOZZI_FUZZ_SEED`. Not part of a plain `cargo test`; `cargo xtask test` runs it. A failing program is printed.
#![allow(missing_docs)]

use mozzi::Scalar;
use mozzi::random::Random;
use mozzi_engine::{Form, Kernel, Program, Shape, Traced, record};
use std::time::{Duration, Instant};

/// A program of operations that keep numbers at size 1 and errors from growing, so that rounding cannot explain a
/// difference; with few or many values alive at once.
fn program(random: &mut Random) -> Program {
    let lengths = [1 + random.below(4), 1 + random.below(60)];
    record("random", &[("a", lengths[0]), ("b", lengths[1])], |arrays| {
        let mut values: Vec<Traced> = arrays.concat();
        let inputs = values.len();
        let most = [8, 60, 300, 1000][random.below(4)];
        let (steps, reach) = (1 + random.below(most), 1 + random.below(120));
        let (half, one) = (Traced::from(0.5), Traced::one());
        for _ in 0..steps {
            // mostly of late values
            let mut some = || {
                let back = if random.below(4) == 0 { values.len() } else { reach.min(values.len()) };
                let x = values[values.len() - 1 - random.below(back)];
                if random.below(5) == 0 { -x } else { x }
            };
            let (a, b, c) = (some(), some(), some());
            let k = random.next();
            let k = Traced::from(if random.below(4) == 0 { k.round() } else { k });
            values.push(match random.below(13) {
                0 => (a + b) * half,
                1 => (a - b) * half,
                2 => a * b * half,
                3 => a.mul_add(b, c) * Traced::from(0.3),
                4 => (a * Traced::from(0.3)).mul_add(b, c * Traced::from(0.3)),
                5 => a.mul_add(k, c) * half,
                6 => half.mul_add(k * half, a * half),
                7 => a / (b * b + one) * half,
                8 => (a * a + one).sqrt() * half,
                9 => (a + k).sin_cos().0 * half,
                10 => a.sin_cos().1,
                11 => values[random.below(inputs)].sgn() * k,
                _ => (a * b - c * k) * Traced::from(0.25),
            });
        }
        let outputs = 1 + random.below(30);
        let mut output = || {
            let x = values[random.below(values.len())];
            if random.below(3) == 0 { -x } else { x }
        };
        vec![("x", (0..outputs).map(|_| output()).collect()), ("y", vec![output()])]
    })
    .expect("short")
}

/// Machine code in every shape and form agrees with the interpreter.
fn check(program: &Program, random: &mut Random) {
    let shapes = Shape::ALL.into_iter().filter(|shape| shape.is_supported() && shape.is_f64());
    for (shape, form) in shapes.flat_map(|shape| [(shape, Form::Blocks), (shape, Form::Rows)]) {
        let lanes = shape.lanes();
        let runs = if form == Form::Rows { 2 } else { 1 };
        if lanes == 1 && form == Form::Rows {
            continue;
        }
        let Ok(kernel) = Kernel::condensing(program, shape, form, usize::MAX) else { continue };
        let place = |width: usize, state: usize, column: usize| match form {
            Form::Blocks => column * lanes + state,
            Form::Rows => state * width + column,
        };
        let (given, found) = kernel.extents().split_at(program.inputs().len());
        let tables: Vec<Vec<f64>> = given.iter().map(|extent| random.vector(extent.of(runs), 1.0)).collect();
        let mut outputs: Vec<Vec<f64>> =
            found.iter().zip(program.outputs()).map(|(extent, _)| vec![f64::NAN; extent.of(runs)]).collect();
        let mut squares = vec![f64::NAN; runs * lanes];
        let inputs: Vec<&[f64]> = tables.iter().map(Vec::as_slice).collect();
        kernel.run(runs, &inputs, &mut outputs.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>(), &mut squares);
        for state in 0..runs * lanes {
            let of = |(x, input): (&Vec<f64>, &mozzi_engine::Array)| {
                (0..input.length).map(|k| x[place(input.length, state, k)]).collect::<Vec<_>>()
            };
            let inputs: Vec<Vec<f64>> = tables.iter().zip(program.inputs()).map(of).collect();
            let expected = program.evaluate(&inputs.iter().map(Vec::as_slice).collect::<Vec<_>>());
            for (expected, found) in expected.iter().zip(&outputs) {
                for (k, x) in expected.iter().enumerate() {
                    let found = found[place(expected.len(), state, k)];
                    let is_near = (found - x).abs() <= 1e-12;
                    assert!(is_near, "{shape:?}, {form:?}, state {state}, output {k}: {found} for {x} in\n{program}");
                }
            }
        }
    }
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

#[test]
fn a_few_random_programs() {
    let mut random = Random(17);
    for _ in 0..60 {
        let program = program(&mut random);
        check(&program, &mut random);
        assert_eq!(program.to_string().parse::<Program>().expect("a program").to_string(), program.to_string());
    }
}

#[test]
#[ignore = "takes its time; cargo xtask test runs it"]
fn programs() {
    let until = Instant::now() + Duration::from_secs(setting("MOZZI_FUZZ_SECONDS", 5));
    let (mut random, mut count) = (Random(setting("MOZZI_FUZZ_SEED", 1)), 0);
    while Instant::now() < until {
        let program = program(&mut random);
        check(&program, &mut random);
        count += 1;
    }
    println!("programs: {count} inputs");
}
