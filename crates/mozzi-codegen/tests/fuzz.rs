//! Compares machine code with the interpreter on random programs: for `MOZZI_FUZZ_SECONDS` (5 by default) from the seed
//! `MOZZI_FUZZ_SEED`. Not part of a plain `cargo test`; `cargo xtask test` runs it. A failing program is printed.
#![allow(missing_docs)]

use mozzi::Scalar;
use mozzi::testing::Random;
use mozzi_codegen::{Kernel, Program, Shape, Traced, record};
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
}

/// Machine code in every shape agrees with the interpreter.
fn check(program: &Program, random: &mut Random) {
    for shape in Shape::ALL.into_iter().filter(|shape| shape.is_supported() && shape.is_f64()) {
        let Ok(kernel) = Kernel::new(program, shape) else { continue };
        let lanes = shape.lanes();
        let blocks: Vec<Vec<f64>> =
            program.inputs().iter().map(|input| random.vector(input.length * lanes, 1.0)).collect();
        let mut outputs: Vec<Vec<f64>> =
            program.outputs().iter().map(|output| vec![f64::NAN; output.values.len() * lanes]).collect();
        let mut squares = vec![f64::NAN; lanes];
        let inputs: Vec<&[f64]> = blocks.iter().map(Vec::as_slice).collect();
        kernel.call(&inputs, &mut outputs.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>(), &mut squares);
        for lane in 0..lanes {
            let state: Vec<Vec<f64>> =
                blocks.iter().map(|x| x.iter().skip(lane).step_by(lanes).copied().collect()).collect();
            let expected = program.evaluate(&state.iter().map(Vec::as_slice).collect::<Vec<_>>());
            for (expected, found) in expected.iter().zip(&outputs) {
                for (k, expected) in expected.iter().enumerate() {
                    let found = found[k * lanes + lane];
                    let is_near = (found - expected).abs() <= 1e-12;
                    assert!(is_near, "{shape:?}, lane {lane}, output {k}: {found} for {expected} in\n{program}");
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
