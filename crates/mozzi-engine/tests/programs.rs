//! Recorded programs, interpreted, compared with the kernels.
#![allow(missing_docs)]

use crate::common;

use common::{compute, error, inputs, quantities, robots, state, tolerance};
use mozzi::quantities::InverseDynamics;
use mozzi::{Dual, Environment, Scalar, Twist, Vec3, Wrench};
use mozzi_engine::{Arguments, Derivative, Product, Program, TooLong, pivot_names, record_quantity};

#[test]
fn every_quantity_of_every_robot() {
    for (name, model) in robots() {
        for query in quantities(&model) {
            let program = record_quantity(&model, query, Arguments::default()).expect("its own frame");
            let text: Program = program.to_string().parse().expect("a program");
            assert_eq!(text.to_string(), program.to_string());
            for seed in 0..3 {
                let state = state(&model, seed);
                let found = program.evaluate(&inputs(query, &state));
                assert_eq!(text.evaluate(&inputs(query, &state)), found);
                let expected = compute(&model, query, seed).expect("regular");
                assert_eq!(found.len(), expected.len() + pivot_names(&query).len());
                for (found, expected) in found.iter().zip(&expected) {
                    let error = error(found, expected);
                    assert!(error < tolerance(query), "{name}, {}: {error:e}", query.name());
                }
            }
        }
    }
}

#[test]
fn folding_leaves_less_work() {
    for (name, model) in robots() {
        for query in quantities(&model) {
            let program = record_quantity(&model, query, Arguments::default()).expect("its own frame");
            let (before, after) = (program.count_before_folding().expect("recorded"), program.count());
            // without springs there is nothing to fold
            assert!(
                after.flops() < before.flops() || before.flops() == 0,
                "{name}, {}: {before}; {after}",
                query.name()
            );
        }
    }
    let ur5 = mozzi_urdf::open("ur5").and_then(|robot| robot.build()).expect("an embedded robot");
    let count = record_quantity(&ur5, InverseDynamics, Arguments::default()).expect("no frame").count();
    assert!(count.flops() < 420, "{count}");
}

#[test]
fn what_is_left_open_is_an_input() {
    let (gravity, about) = ([1.0, 2.0, -3.0], [0.3, -0.2, 0.1]);
    let (twist, acceleration) = ([0.2, -0.4, 0.6, 0.8, -1.0, 1.2], [3.0, 1.0, -2.0, 0.5, 4.0, -1.0]);
    let (push, pull, none) = ([0.1, 0.2, 0.3, 4.0, 5.0, 6.0], [-1.0, 0.5, 0.7, -3.0, 2.0, 1.0], [0.0; 6]);
    for (name, model) in robots() {
        let frames: Vec<_> = model.frames().map(|(frame, _)| frame).collect();
        let frames = [frames[frames.len() - 1], frames[frames.len() / 2]];
        let open = Arguments {
            parameters: true,
            gravity: true,
            base_twist: true,
            base_acceleration: true,
            about: true,
            wrenches: &frames,
            derivative: Derivative::None,
        };
        let [tip, middle] = frames.map(|frame| format!("wrench_{}", model.frame_name(frame)));
        let names = ["parameters", "gravity", "base_twist", "base_acceleration", "about", &tip, &middle];
        let applied = [(frames[0], Wrench::from_array(push)), (frames[1], Wrench::from_array(pull))];
        let environment = Environment {
            gravity: Vec3(gravity),
            base_twist: Twist::from_array(twist),
            base_acceleration: Twist::from_array(acceleration),
            applied: &applied,
        };
        let (state, pi) = (state(&model, 5), model.parameters());
        for query in quantities(&model) {
            let program = record_quantity(&model, query, open).expect("its own frames");
            let state = inputs(query, &state);
            let further: Vec<_> = program.inputs()[state.len()..].iter().map(|input| input.name.as_str()).collect();
            assert_eq!(further, names);
            let run = |pi: &[f64], push: &[f64], pull: &[f64]| {
                program.evaluate(&[&state[..], &[pi, &gravity, &twist, &acceleration, &about, push, pull]].concat())
            };
            let expected = model.compute(query.about(Vec3(about)), &state, &environment).expect("regular");
            for (found, expected) in run(&pi, &push, &pull).iter().zip(&expected) {
                let error = error(found, expected);
                assert!(error < 1e-9, "{name}, {}: {error:e}", query.name());
            }
            // half the masses and frictions, half the forces
            if query == InverseDynamics.into() {
                let half: Vec<f64> = pi.iter().map(|x| x / 2.0).collect();
                let (whole, halves) = (run(&pi, &none, &none), run(&half, &none, &none));
                let twice: Vec<f64> = halves[0].iter().map(|x| 2.0 * x).collect();
                assert!(error(&twice, &whole[0]) < 1e-13, "{name}");
            }
        }
        let one = Arguments { wrenches: &frames[..1], ..Arguments::default() };
        let program = record_quantity(&model, InverseDynamics, one).expect("its own frame");
        assert_eq!(program.inputs().last().map(|input| input.name.as_str()), Some("wrench"));
    }
}

#[test]
fn rates_are_those_of_dual_numbers() {
    for (name, model) in robots() {
        let ([theta, dtheta, x], [_, u, v]) = (state(&model, 1), state(&model, 2));
        let arguments = Arguments { derivative: Derivative::RATES, gravity: true, ..Arguments::default() };
        for query in quantities(&model) {
            let program = record_quantity(&model, query, arguments).expect("its own frames");
            let plain = record_quantity(&model, query, Arguments { derivative: Derivative::None, ..arguments })
                .expect("its own frames");
            let (own, of) = (plain.inputs().len(), [theta.clone(), dtheta.clone(), x.clone()]);
            let gravity = [0.5, 1.0, -9.0];
            let values = [inputs(query, &of), vec![&gravity[..]]].concat();
            let along = [u.clone(), v.clone(), u.iter().zip(&v).map(|(u, v)| u - v).collect()];
            let rates = [inputs(query, &along), vec![&[0.1, 0.2, 0.3][..]]].concat();
            assert_eq!(program.inputs()[own].name, format!("{}_rate", plain.inputs()[0].name));
            let found = program.evaluate(&[&values[..], &rates].concat());

            let seeded = plain.inputs().iter().zip(values.iter().zip(&rates)).map(|(array, (x, rate))| {
                if array.name == "theta" { mozzi::model::seed_direction(&model, x, rate) } else { Dual::list(x, rate) }
            });
            let seeded: Vec<Vec<Dual>> = seeded.collect();
            let expected = plain.evaluate(&seeded.iter().map(Vec::as_slice).collect::<Vec<_>>());
            let outputs = query.declaration().outputs.len();
            assert_eq!(found.len(), plain.outputs().len() + outputs);
            for (k, expected) in expected.iter().enumerate() {
                let part = |of: fn(&Dual) -> f64| expected.iter().map(of).collect::<Vec<f64>>();
                let place = if k < outputs { k } else { k + outputs }; // pivots come last
                assert!(error(&found[place], &part(|x| x.value)) < tolerance(query), "{name}, {}", query.name());
                if k < outputs {
                    let error = error(&found[outputs + k], &part(|x| x.derivative));
                    assert!(error < 1e3 * tolerance(query), "{name}, {}: {error:e}", query.name());
                }
            }
        }
        // τ along (θ, θ̇, θ̈) by the full matrices
        let tau = record_quantity(
            &model,
            InverseDynamics,
            Arguments { derivative: Derivative::RATES, ..Arguments::default() },
        );
        let found = tau.expect("no frame").evaluate(&[&theta, &dtheta, &x, &u, &v, &u].map(|x| &x[..])).remove(1);
        let full = model.inverse_dynamics_derivatives(&theta, &dtheta, &x, &model.environment()).expect("lengths");
        let [u, v] = [u, v].map(mozzi::nalgebra::DVector::from_vec);
        let expected = full.d_theta * &u + full.d_dtheta * v + full.d_ddtheta * u;
        assert!(error(&found, expected.as_slice()) < 1e-12, "{name}");
    }
}

/// The forward products against dual numbers, the backward ones by wᵀ(∂f u) = (wᵀ∂f) u, for all quantities.
#[test]
fn products_are_those_of_dual_numbers() {
    let product = |along: [u32; 2], gradient: u32| Derivative::Product(Product { along, gradient });
    for (k, (name, model)) in robots().into_iter().enumerate() {
        let states = [1, 2, 3].map(|seed| state(&model, seed));
        let change =
            |seed: f64| (0..model.parameter_count()).map(|k| (1.3 * k as f64 + seed).sin()).collect::<Vec<f64>>();
        let masses = [model.parameters(), change(1.0), change(2.0)];
        // each quantity on every third robot
        for query in quantities(&model).into_iter().filter(|query| (query.index() + k) % 3 == 0) {
            let arguments = |derivative| Arguments { parameters: true, derivative, ..Arguments::default() };
            let record = |derivative| record_quantity(&model, query, arguments(derivative)).expect("its own frames");
            let plain = record(Derivative::None);
            let [x, u, v] = [0, 1, 2].map(|k| [inputs(query, &states[k]), vec![&masses[k][..]]].concat());
            // all inputs change along u, but the first along v
            let (all, most) = ((1 << x.len()) - 1, ((1 << x.len()) - 1) & !1);
            let outputs = query.declaration().outputs.len();

            let twice: Vec<Vec<Dual<Dual>>> = (x.iter().zip(&u).zip(&v).enumerate())
                .map(|(k, ((x, u), v))| {
                    let second = if k == 0 { vec![0.0; v.len()] } else { v.to_vec() };
                    Dual::list(&Dual::list(x, u), &Dual::constants(&second))
                })
                .collect();
            let exact = plain.evaluate(&twice.iter().map(Vec::as_slice).collect::<Vec<_>>());
            let exact: Vec<Dual<Dual>> = exact.into_iter().take(outputs).flatten().collect();
            let part = |of: fn(&Dual<Dual>) -> f64| exact.iter().map(of).collect::<Vec<f64>>();
            let (once, twice) = (part(|y| y.value.derivative), part(|y| y.derivative.derivative));

            let (u_all, v_most) = (u.concat(), v[1..].concat());
            let w: Vec<f64> = (0..once.len()).map(|k| (1.7 * k as f64 + 0.3).sin()).collect();
            let run =
                |derivative, further: &[&[f64]]| record(derivative).evaluate(&[&x[..], further].concat()).remove(0);
            let close = |found: &[f64], expected: &[f64], what: &str| {
                let error = error(found, expected);
                assert!(error < 1e4 * tolerance(query), "{name}, {}, {what}: {error:e}", query.name());
            };
            close(&run(product([all, 0], 0), &[&u_all]), &once, "∂f u");
            close(&run(product([all, most], 0), &[&u_all, &v_most]), &twice, "∂²f(u, v)");

            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let size = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum::<f64>() + 1e-3;
            let same = |a: (&[f64], &[f64]), b: (&[f64], &[f64]), what: &str| {
                let error = (dot(a.0, a.1) - dot(b.0, b.1)).abs() / (size(a.0, a.1) + size(b.0, b.1));
                assert!(error < 1e4 * tolerance(query), "{name}, {}, {what}: {error:e}", query.name());
            };
            same((&run(product([0, 0], all), &[&w]), &u_all), (&w, &once), "wᵀ∂f");
            same((&run(product([all, 0], most), &[&u_all, &w]), &v_most), (&w, &twice), "wᵀ∂²f u");
        }
    }
}

#[test]
fn a_recording_is_bounded() {
    let endless = mozzi_engine::record("long", &[("x", 1)], |x| {
        let one = mozzi_engine::Traced::from(1.0);
        vec![("y", vec![(0..5_000_000).fold(x[0][0], |sum, k| sum + one * mozzi_engine::Traced::from(f64::from(k)))])]
    });
    assert_eq!(endless, Err(TooLong));
    assert_eq!(TooLong.to_string(), "longer than 4000000 steps, which take 500 MB");
}

#[test]
fn programs_run_on_any_scalar() {
    // the derivative of τ along θ̈ is M's product
    let model = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    let program = record_quantity(&model, InverseDynamics, Arguments::default()).expect("no frame");
    let [theta, dtheta, ddtheta] = state(&model, 1);
    let (along, zero) = (vec![1.0; model.n()], vec![0.0; model.n()]);
    let duals = [Dual::list(&theta, &zero), Dual::list(&dtheta, &zero), Dual::list(&ddtheta, &along)];
    let tau = program.evaluate(&duals.each_ref().map(Vec::as_slice)).remove(0);
    let M = model.mass_matrix(&theta).expect("lengths");
    let found: Vec<f64> = tau.iter().map(|x| x.derivative).collect();
    let expected: Vec<f64> = M.row_iter().map(|row| row.sum()).collect();
    assert!(error(&found, &expected) < 1e-14);
    // f32 agrees with f64 to seven digits
    let single = [&theta, &dtheta, &ddtheta].map(|x| x.iter().map(|&x| x as f32).collect::<Vec<_>>());
    let rounded = single.each_ref().map(|x| x.iter().map(|&x| f64::from(x)).collect::<Vec<_>>());
    let tau = program.evaluate(&single.each_ref().map(Vec::as_slice)).remove(0);
    let expected = program.evaluate(&rounded.each_ref().map(Vec::as_slice)).remove(0);
    assert!(error(&tau.iter().map(|&x| f64::from(x)).collect::<Vec<_>>(), &expected) < 2e-6);
}

#[test]
fn signs_and_shared_operations_are_free() {
    let program = mozzi_engine::record("p", &[("x", 3)], |x| {
        let [a, b, c] = [x[0][0], x[0][1], x[0][2]];
        let o = mozzi_engine::Traced::zero();
        let y = (a - b) * (b - a) + o * c; // −(a − b)²
        vec![("y", vec![y, -y, (-a).mul_add(-b, -(-c)), a * b + c, -(a - b), a / -b, (-a).sgn()])]
    })
    .expect("short");
    let count = program.count();
    assert_eq!((count.add, count.mul, count.fma, count.div), (1, 1, 2, 1), "{program}");
    let found = program.evaluate(&[&[3.0, 5.0, 7.0]]);
    assert_eq!(found, [[-4.0, 4.0, 22.0, 22.0, 2.0, -0.6, -1.0]]);
}
