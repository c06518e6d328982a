//! Against closed solutions, conservation laws, the orders of the methods, and Runge-Kutta 4 of `mozzi`.

use super::*;
use crate::{Error, Policy};
use mozzi::model::description::{Joint, JointKind};
use mozzi::nalgebra::DMatrix;
use mozzi::simulation::{Friction, Options, Zero, torque};
use mozzi::testing::{distance, floating_tree, state, tree};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Vec3};
use std::f64::consts::PI;

const DOPRI: Integrator = Integrator::DormandPrince { tolerance: 1e-10 };

fn robot(name: &str) -> Model {
    mozzi_urdf::open(name).expect("embedded").build().expect("sound")
}

/// One joint of 1.5 kg at 0.6 m about y, hanging at 0; or, along z, a slide.
fn single(slides: bool, limits: Option<[f64; 2]>) -> Model {
    let (w, v) = if slides { ([0.0; 3], [0.0, 0.0, 1.0]) } else { ([0.0, 1.0, 0.0], [0.0; 3]) };
    let axis = JointKind::Screw(ScrewAxis::new(w, v).expect("unit"));
    let mut joint = Joint::new("pivot", "base", "bob", SE3::identity(), axis);
    joint.limits.position = limits;
    let bob = SpatialInertia::point_mass(1.5, Vec3([0.0, 0.0, -0.6]));
    Description::new("single")
        .link("base", SpatialInertia::zero())
        .link("bob", bob)
        .joint(joint)
        .build()
        .expect("sound")
}

/// T = 2π √(l/g) / agm(1, cos(θ₀/2)).
fn period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    2.0 * PI * (0.6_f64 / 9.81).sqrt() / a
}

#[test]
fn a_pendulum_passes_the_bottom_on_time() {
    let (robot, T) = (single(false, None), period(1.2));
    for (integrator, tolerance) in [
        (DOPRI, 1e-8),
        (Integrator::Fixed(Method::RungeKutta4, 1e-3), 1e-8),
        (Integrator::Midpoint { step: 1e-3 }, 1e-5),
    ] {
        let down = Event { direction: Direction::Falling, ..Event::new("down", |_, theta, _| theta[0]) };
        let turn = Event::new("turns", |_, _, dtheta| dtheta[0]);
        let simulation = Simulation { integrator, events: vec![down, turn], ..Simulation::new(1.9 * T) };
        let run = simulation.run(&robot, &[1.2], &[0.0], Zero).expect("a motion");
        let times = |name: &str| run.events.iter().filter(|e| e.name == name).map(|e| e.t).collect::<Vec<_>>();
        for (found, expected) in [(times("down"), vec![0.25, 1.25]), (times("turns"), vec![0.5, 1.0, 1.5])] {
            assert_eq!(found.len(), expected.len(), "{integrator:?}: {found:?}");
            for (t, part) in found.iter().zip(expected) {
                assert!((t - part * T).abs() < tolerance, "{integrator:?}: {t} {}", part * T);
            }
        }
        // one that ends the simulation
        let stop = Event { stop: true, ..Event::new("up", |_, theta, _| theta[0]) };
        let run =
            Simulation { integrator, events: vec![stop], ..Simulation::new(1.9 * T) }.run(&robot, &[1.2], &[0.0], Zero);
        let run = run.expect("a motion");
        let last = run.motion.last();
        assert!(!run.motion.complete && (last.t - 0.25 * T).abs() < tolerance && last.theta[0].abs() < 1e-11);
        assert!((last.theta[0], last.t) == (run.events[0].theta[0], run.events[0].t));
    }
}

#[test]
fn rows_between_the_steps_are_as_good_as_those_at_their_ends() {
    let (model, start) = (robot("double_pendulum"), [2.0, 1.0]);
    let push = || torque(|t, _, dtheta, tau| (tau[0], tau[1]) = (0.4 * t - 0.1 * dtheta[0], -0.2 * dtheta[1]));
    let simulation = Simulation { integrator: DOPRI, record: 0.003, ..Simulation::new(1.0) };
    let run = simulation.run(&model, &start, &[0.0; 2], push()).expect("a motion").motion;
    assert!(run.complete && run.len() == 335 && run.steps < 300, "{} rows, {} steps", run.len(), run.steps);
    let reference = model.simulate(&start, &[0.0; 2], push(), &Options::new(1.0, 1000)).expect("a motion");
    for row in run.samples() {
        let expected = reference.sample((row.t * 1000.0).round() as usize);
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart(row.theta, expected.theta) < 1e-7 && apart(row.dtheta, expected.dtheta) < 1e-6, "{}", row.t);
        assert!(apart(row.ddtheta, expected.ddtheta) < 1e-5 && apart(row.tau, expected.tau) < 1e-6, "{}", row.t);
        assert!((row.energy.motor_work - expected.energy.motor_work).abs() < 1e-6);
    }
    assert!(run.largest_drift() < 1e-6);
}

#[test]
fn errors_follow_the_tolerance_on_the_group() {
    let model = floating_tree(4, 5, 0);
    let [theta, dtheta, _] = state(&model, 6);
    let friction = Friction::Smooth { slip_speed: 0.5 };
    let options = Options { friction, record_every: 4000, ..Options::new(0.1, 4000) };
    let best = model.simulate(&theta, &dtheta, Zero, &options).expect("a motion");
    for (tolerance, bound) in [(1e-5, 1e-3), (1e-8, 1e-6), (1e-11, 1e-8)] {
        let integrator = Integrator::DormandPrince { tolerance };
        let run = Simulation { integrator, friction, ..Simulation::new(0.1) }
            .run(&model, &theta, &dtheta, Zero)
            .expect("fine")
            .motion;
        let found = run.last().theta.iter().chain(run.last().dtheta);
        let expected = best.last().theta.iter().chain(best.last().dtheta);
        let error = found.zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("tolerance {tolerance:e}: {} steps, error {error:.1e}", run.steps);
        assert!(error < bound, "{tolerance:e}: {error:e}");
    }
}

#[test]
fn a_fixed_step_is_the_step_of_mozzi() {
    for (model, method) in [(tree(3, 5, 1), Method::RungeKutta4), (floating_tree(2, 4, 0), Method::SemiImplicitEuler)] {
        let [theta, dtheta, _] = state(&model, 1);
        let expected =
            model.simulate(&theta, &dtheta, Zero, &Options { method, ..Options::new(0.05, 50) }).expect("a motion");
        let simulation =
            Simulation { integrator: Integrator::Fixed(method, 1e-3), record: 1e-3, ..Simulation::new(0.05) };
        let found = simulation.run(&model, &theta, &dtheta, Zero).expect("a motion").motion;
        assert_eq!((found.len(), found.steps), (51, 50));
        assert!(found.theta.iter().zip(&expected.theta).all(|(a, b)| (a - b).abs() < 1e-9));
        assert!((found.largest_drift() - expected.largest_drift()).abs() < 1e-9 * expected.largest_kinetic_energy());
    }
}

#[test]
fn the_midpoint_rule_is_of_second_order_and_turns_back() {
    for model in [tree(6, 4, 0), floating_tree(5, 3, 1)] {
        let [theta, dtheta, _] = state(&model, 6);
        let free = Simulation {
            gravity: Some(Vec3([0.0, 0.0, -3.0])),
            friction: Friction::Smooth { slip_speed: 1.0 },
            ..Simulation::new(0.05)
        };
        let end = |integrator, theta: &[f64], dtheta: &[f64]| {
            let run = Simulation { integrator, ..clone(&free) }.run(&model, theta, dtheta, Zero);
            let motion = run.expect("a motion").motion;
            (motion.last().theta.to_vec(), motion.last().dtheta.to_vec())
        };
        let best = end(Integrator::DormandPrince { tolerance: 1e-12 }, &theta, &dtheta);
        let error = |step| {
            let found = end(Integrator::Midpoint { step }, &theta, &dtheta);
            found
                .0
                .iter()
                .zip(&best.0)
                .chain(found.1.iter().zip(&best.1))
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(1e-3) / error(5e-4)).log2();
        assert!((order - 2.0).abs() < 0.2, "{order}");
    }
    // without friction: there, and with the velocities turned round back again
    let model = floating_tree(8, 3, 0);
    let [theta, dtheta, _] = state(&model, 2);
    let frictionless = {
        let mut robot = model.description().clone();
        robot.joints.iter_mut().for_each(|joint| (joint.damping, joint.friction) = (0.0, 0.0));
        robot.build().expect("sound")
    };
    let simulation = Simulation { integrator: Integrator::Midpoint { step: 1e-3 }, ..Simulation::new(0.1) };
    let there = simulation.run(&frictionless, &theta, &dtheta, Zero).expect("a motion").motion;
    let back: Vec<f64> = there.last().dtheta.iter().map(|v| -v).collect();
    let again = simulation.run(&frictionless, there.last().theta, &back, Zero).expect("a motion").motion;
    assert!(there.last().theta.iter().zip(&theta).any(|(a, b)| (a - b).abs() > 0.01));
    assert!(again.last().theta.iter().zip(&theta).all(|(a, b)| (a - b).abs() < 1e-10));
    assert!(again.last().dtheta.iter().zip(&dtheta).all(|(a, b)| (a + b).abs() < 1e-9));
}

fn clone(simulation: &Simulation) -> Simulation<'static> {
    let &Simulation { integrator, duration, record, gravity, friction, stops, .. } = simulation;
    Simulation { integrator, record, gravity, friction, stops, ..Simulation::new(duration) }
}

#[test]
fn the_midpoint_rule_is_symplectic() {
    // D of (θ, p) → (θ, p) over a few steps, by differences: DᵀΩD = Ω. Runge-Kutta's steps of the same size are not.
    let model = robot("double_pendulum");
    let defect = |integrator: Integrator| {
        let map = |x: &[f64]| {
            let M = model.mass_matrix(&x[..2]).expect("lengths");
            let dtheta = M.lu().solve(&mozzi::nalgebra::DVector::from_column_slice(&x[2..])).expect("regular");
            let run = Simulation { integrator, ..Simulation::new(0.5) }.run(&model, &x[..2], dtheta.as_slice(), Zero);
            let motion = run.expect("a motion").motion;
            let end = motion.last();
            let p = model.mass_matrix(end.theta).expect("lengths")
                * mozzi::nalgebra::DVector::from_column_slice(end.dtheta);
            [end.theta, p.as_slice()].concat()
        };
        let (x, e) = ([1.0, 0.7, 0.5, 0.3], 1e-5);
        let mut D = DMatrix::zeros(4, 4);
        for c in 0..4 {
            let moved = |e: f64| {
                let mut x = x;
                x[c] += e;
                map(&x)
            };
            for (r, (a, b)) in moved(e).iter().zip(moved(-e)).enumerate() {
                D[(r, c)] = (a - b) / (2.0 * e);
            }
        }
        let mut Omega = DMatrix::zeros(4, 4);
        (0..2).for_each(|k| (Omega[(k, k + 2)], Omega[(k + 2, k)]) = (1.0, -1.0));
        (D.transpose() * &Omega * D - Omega).amax()
    };
    let (midpoint, euler) =
        (defect(Integrator::Midpoint { step: 0.02 }), defect(Integrator::Fixed(Method::SemiImplicitEuler, 0.02)));
    assert!(midpoint < 1e-7 && euler > 1e-3, "{midpoint:e} {euler:e}");
}

/// Largest drift in the first and in the last half of a motion, over the largest kinetic energy.
fn early_and_late(model: &Model, theta: &[f64], dtheta: &[f64], simulation: &Simulation) -> [f64; 2] {
    let motion = simulation.run(model, theta, dtheta, Zero).expect("a motion").motion;
    let (rows, K) = (motion.len(), motion.largest_kinetic_energy());
    let largest = |rows: std::ops::Range<usize>| rows.map(|k| motion.drift(k).abs()).fold(0.0, f64::max) / K;
    [largest(0..rows / 2), largest(rows / 2..rows)]
}

#[test]
fn the_midpoint_rules_energy_is_bounded() {
    let step = 0.005;
    let pendulum = robot("double_pendulum");
    let simulation = Simulation { integrator: Integrator::Midpoint { step }, record: step, ..Simulation::new(10.0) };
    let [early, late] = early_and_late(&pendulum, &[2.0, 1.0], &[0.0; 2], &simulation);
    assert!(late < 2.0 * early && late < 1e-2, "{early:e} {late:e}");
    // adrift, on SE(3)
    let adrift = {
        let mut robot = floating_tree(8, 2, 0).description().clone();
        robot.joints.iter_mut().for_each(|joint| (joint.damping, joint.friction) = (0.0, 0.0));
        robot.gravity = [0.0; 3];
        robot.build().expect("sound")
    };
    let [theta, dtheta, _] = state(&adrift, 8);
    let [early, late] = early_and_late(&adrift, &theta, &dtheta, &simulation);
    assert!(early < 1e-3 && late < 1e-3, "{early:e} {late:e}");
    // and its momentum to rounding
    let motion = simulation.run(&adrift, &theta, &dtheta, Zero).expect("a motion").motion;
    let momentum = |k: usize| {
        let row = motion.sample(k);
        adrift.momentum(row.theta, row.dtheta, Vec3::zero()).expect("lengths")
    };
    let lost = (0..motion.len()).map(|k| (momentum(k) - momentum(0)).norm()).fold(0.0, f64::max);
    assert!(lost < 1e-11 * momentum(0).norm(), "{lost:e}");
}

/// A million steps: seconds in release, so `cargo test --release -p mozzi-motion -- --ignored million`.
#[test]
#[ignore = "a million steps"]
fn the_midpoint_rules_energy_is_bounded_over_a_million_steps() {
    let step = 0.001;
    let simulation =
        Simulation { integrator: Integrator::Midpoint { step }, record: 0.01, ..Simulation::new(1e6 * step) };
    let [early, late] = early_and_late(&robot("double_pendulum"), &[2.0, 1.0], &[0.0; 2], &simulation);
    println!("drift over the largest kinetic energy: {early:.2e} in the first half, {late:.2e} in the last");
    assert!(late < 1.2 * early && late < 1e-3, "{early:e} {late:e}");
}

#[test]
fn a_slide_falls_onto_its_stop_and_is_lifted_off() {
    // 1.5 kg fall 0.2 m; at 1 s a motor begins to lift, by 10 N a second: off at 1 s + 14.715 N / 10 N/s
    let (fall, g) = (0.2, 9.81);
    let slide = single(true, Some([-fall, 5.0]));
    let lift = || torque(|t, _, _, tau| tau[0] = 10.0 * (t - 1.0).max(0.0));
    let off = 1.0 + 1.5 * g / 10.0;
    for integrator in [DOPRI, Integrator::Fixed(Method::RungeKutta4, 1e-3), Integrator::Midpoint { step: 1e-3 }] {
        let simulation = Simulation { integrator, stops: Policy::Respect, record: 1e-2, ..Simulation::new(3.0) };
        let run = simulation.run(&slide, &[0.0], &[0.0], lift()).expect("a motion");
        let [stop] = &run.stops[..] else { panic!("{:?}", run.stops) };
        assert!((stop.first - (2.0 * fall / g).sqrt()).abs() < 1e-6, "{stop:?}");
        assert_eq!((stop.joint.as_str(), stop.limit, stop.beyond, stop.times), ("pivot", -fall, 0.0, 1));
        for row in run.motion.samples() {
            assert!(row.theta[0] >= -fall, "{} {}", row.t, row.theta[0]);
            assert!(
                !(row.t > stop.first && row.t < off) || (row.theta[0] == -fall && row.dtheta[0] == 0.0),
                "{}",
                row.t
            );
        }
        // lifted by ∫∫ 10 (t − off)/m
        let expected = -fall + 10.0 / 1.5 * (3.0 - off).powi(3) / 6.0;
        let found = run.motion.last().theta[0];
        assert!((found - expected).abs() < 1e-6, "{integrator:?}: {found} {expected}");
        // what the impact took is counted
        let end = run.motion.last().energy;
        assert!((end.friction_loss - 1.5 * g * fall).abs() < 1e-5 && run.motion.largest_drift() < 1e-4, "{end:?}");
    }
    let start = Simulation { stops: Policy::Respect, ..Simulation::new(1.0) }
        .run(&slide, &[-0.3], &[0.0], Zero)
        .expect_err("beyond");
    assert!(start.to_string().contains("-0.3 of joint `pivot`, beyond its limits -0.2 … 5"), "{start}");
}

#[test]
fn stops_of_a_chain_take_energy_and_are_never_passed() {
    let mut robot = robot("double_pendulum").description().clone();
    for joint in &mut robot.joints {
        joint.limits.position = Some([-0.6, 1.0]);
    }
    let model = robot.build().expect("sound");
    let run = |stops: Policy| {
        Simulation { integrator: DOPRI, stops, record: 1e-2, ..Simulation::new(4.0) }
            .run(&model, &[0.9, -0.5], &[0.0; 2], Zero)
            .expect("a motion")
    };
    let respected = run(Policy::Respect);
    assert!(respected.motion.theta.iter().all(|q| (-0.6..=1.0).contains(q)));
    assert!(
        respected.stops.len() >= 2 && respected.stops.iter().all(|stop| stop.beyond == 0.0),
        "{:?}",
        respected.stops
    );
    assert!(respected.motion.largest_drift() < 1e-6, "{}", respected.motion.largest_drift());
    assert!(respected.motion.last().energy.friction_loss > 0.5);
    let losses: Vec<f64> = respected.motion.energy.iter().map(|e| e.friction_loss).collect();
    assert!(losses.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12));
    let (reported, ignored) = (run(Policy::Report), run(Policy::Ignore));
    assert_eq!(reported.motion, ignored.motion);
    assert!(ignored.stops.is_empty() && reported.stops.iter().any(|stop| stop.beyond > 0.1 && stop.times > 0));
}

#[test]
fn a_free_top_turns_as_euler_says() {
    // as of a symmetric body: e^{[H/I] t} in space and a turn about its own axis
    let (I, I3, t, w) = (0.3, 0.5, 2.0, Vec3([0.8, -0.3, 1.5]));
    let body = SpatialInertia::new(2.0, Vec3::zero(), mozzi::Sym3::diagonal(I, I, I3));
    let top = Description::new("top").link("body", body).floating().build().expect("sound");
    let start = top.neutral_configuration::<f64>();
    let simulation = Simulation { gravity: Some(Vec3::zero()), integrator: DOPRI, ..Simulation::new(t) };
    let end = simulation.run(&top, &start, &[w.0, [0.0; 3]].concat(), Zero).expect("a motion").motion;
    let turn = |w: Vec3| SE3::exp(mozzi::Twist { w, v: Vec3::zero() });
    let H = Vec3([I * w.0[0], I * w.0[1], I3 * w.0[2]]);
    let expected = turn(H * (t / I)) * turn(Vec3([0.0, 0.0, (1.0 - I3 / I) * w.0[2] * t]));
    let T = SE3::from_pose(*end.last().theta.first_chunk().expect("seven"));
    assert!(distance(T, expected) < 1e-7, "{}", distance(T, expected));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let model = robot("double_pendulum");
    let words = |simulation: Simulation, words: &str| {
        let error = simulation.run(&model, &[0.0; 2], &[0.0; 2], Zero).expect_err("refused").to_string();
        assert!(error.contains(words), "{error}");
    };
    words(Simulation { integrator: Integrator::Midpoint { step: 0.0 }, ..Simulation::new(1.0) }, "step is 0");
    words(
        Simulation { integrator: Integrator::DormandPrince { tolerance: -1.0 }, ..Simulation::new(1.0) },
        "tolerance is -1",
    );
    words(Simulation { record: 0.0, ..Simulation::new(1.0) }, "time between two rows");
    words(Simulation::new(f64::NAN), "duration is NaN");
    // too long a step for the implicit rule; a jump that no step is short enough for
    let wild = Simulation { integrator: Integrator::Midpoint { step: 0.5 }, ..Simulation::new(1.0) };
    let error = wild.run(&model, &[2.0, 1.0], &[9.0, -20.0], Zero).expect_err("too long");
    assert!(matches!(error, Error::NoConvergence { .. } | Error::Model(mozzi::Error::Diverged { .. })), "{error}");
    let jump = torque(|t, _, _, tau| tau[0] = if t > 0.3 { f64::NAN } else { 0.0 });
    assert!(Simulation::new(1.0).run(&model, &[0.0; 2], &[0.0; 2], jump).is_err());
    let still = Simulation::new(0.0).run(&model, &[0.3, 0.1], &[0.0; 2], Zero).expect("no motion");
    assert!(still.motion.complete && still.motion.last().theta == [0.3, 0.1]);
}
