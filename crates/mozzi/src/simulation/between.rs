//! Events, stops, rows between the steps, adaptive and implicit methods: compared with closed-form solutions,
//! conservation laws, the orders of the methods, and Runge-Kutta 4.

extern crate std;
use super::robots::double_pendulum;
use super::{Direction, Event, Friction, Method, Options, Policy, Simulation, Zero, torque};
use crate::model::description::{Joint, JointKind};
use crate::testing::{distance, floating_tree, state, tree};
use crate::{Description, Error, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3};
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;
use nalgebra::DMatrix;

const DOPRI: Method = Method::DormandPrince { tolerance: 1e-10 };

/// Options with steps of this many seconds.
fn by(method: Method, duration: f64, step: f64) -> Options {
    Options { method, ..Options::with_step(duration, step).expect("fits") }
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
    for (method, tolerance) in [(DOPRI, 1e-8), (Method::RungeKutta4, 1e-8), (Method::Midpoint, 1e-5)] {
        let options = by(method, 1.9 * T, 1e-3);
        let down = Event { direction: Direction::Falling, ..Event::new("down", |_, theta, _| theta[0]) };
        let turn = Event::new("turns", |_, _, dtheta| dtheta[0]);
        let simulation = Simulation { events: vec![down, turn], ..Simulation::new(options) };
        let run = simulation.run(&robot, &[1.2], &[0.0], Zero).expect("a motion");
        let times = |name: &str| run.events.iter().filter(|e| e.name == name).map(|e| e.t).collect::<Vec<_>>();
        for (found, expected) in [(times("down"), vec![0.25, 1.25]), (times("turns"), vec![0.5, 1.0, 1.5])] {
            assert_eq!(found.len(), expected.len(), "{method:?}: {found:?}");
            for (t, part) in found.iter().zip(expected) {
                assert!((t - part * T).abs() < tolerance, "{method:?}: {t} {}", part * T);
            }
        }
        // one that ends the simulation
        let stop = Event { stop: true, ..Event::new("up", |_, theta, _| theta[0]) };
        let simulation = Simulation { events: vec![stop], ..Simulation::new(options) };
        let run = simulation.run(&robot, &[1.2], &[0.0], Zero);
        let run = run.expect("a motion");
        let last = run.motion.last();
        assert!(!run.motion.complete && (last.t - 0.25 * T).abs() < tolerance && last.theta[0].abs() < 1e-11);
        assert!((last.theta[0], last.t) == (run.events[0].theta[0], run.events[0].t));
    }
}

#[test]
fn rows_between_the_steps_are_as_good_as_those_at_their_ends() {
    let (model, start) = (double_pendulum(), [2.0, 1.0]);
    let push = || torque(|t, _, dtheta, tau| (tau[0], tau[1]) = (0.4 * t - 0.1 * dtheta[0], -0.2 * dtheta[1]));
    let options = Options { method: DOPRI, record_every: 3, ..Options::new(1.0, 1000) };
    let run = model.simulate(&start, &[0.0; 2], push(), &options).expect("a motion");
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
        let options = Options { method: Method::DormandPrince { tolerance }, friction, ..Options::new(0.1, 100) };
        let run = model.simulate(&theta, &dtheta, Zero, &options).expect("fine");
        let found = run.last().theta.iter().chain(run.last().dtheta);
        let expected = best.last().theta.iter().chain(best.last().dtheta);
        let error = found.zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        std::println!("tolerance {tolerance:e}: {} steps, error {error:.1e}", run.steps);
        assert!(error < bound, "{tolerance:e}: {error:e}");
    }
}

#[test]
fn an_event_that_is_reported_leaves_the_motion_as_it_is() {
    for (model, method) in [(tree(3, 5, 1), Method::RungeKutta4), (floating_tree(2, 4, 0), Method::SemiImplicitEuler)] {
        let [theta, dtheta, _] = state(&model, 1);
        let options = Options { method, ..Options::new(0.05, 50) };
        let expected = model.simulate(&theta, &dtheta, Zero, &options).expect("a motion");
        let events = vec![Event::new("half time", |t, _, _| t - 0.0254)];
        let simulation = Simulation { events, ..Simulation::new(options) };
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
        let end = |method, step| {
            let free = Options {
                gravity: Some(Vec3([0.0, 0.0, -3.0])),
                friction: Friction::Smooth { slip_speed: 1.0 },
                ..by(method, 0.05, step)
            };
            let motion = model.simulate(&theta, &dtheta, Zero, &free).expect("a motion");
            (motion.last().theta.to_vec(), motion.last().dtheta.to_vec())
        };
        let best = end(Method::DormandPrince { tolerance: 1e-12 }, 1e-3);
        let error = |step| {
            let found = end(Method::Midpoint, step);
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
    // without friction: forward, then back with reversed velocities
    let model = floating_tree(8, 3, 0);
    let [theta, dtheta, _] = state(&model, 2);
    let frictionless = {
        let mut robot = model.description().clone();
        robot.joints.iter_mut().for_each(|joint| (joint.damping, joint.friction) = (0.0, 0.0));
        robot.build().expect("sound")
    };
    let options = by(Method::Midpoint, 0.1, 1e-3);
    let there = frictionless.simulate(&theta, &dtheta, Zero, &options).expect("a motion");
    let back: Vec<f64> = there.last().dtheta.iter().map(|v| -v).collect();
    let again = frictionless.simulate(there.last().theta, &back, Zero, &options).expect("a motion");
    assert!(there.last().theta.iter().zip(&theta).any(|(a, b)| (a - b).abs() > 0.01));
    assert!(again.last().theta.iter().zip(&theta).all(|(a, b)| (a - b).abs() < 1e-10));
    assert!(again.last().dtheta.iter().zip(&dtheta).all(|(a, b)| (a + b).abs() < 1e-9));
}

#[test]
fn the_midpoint_rule_is_symplectic() {
    // the Jacobian D of (θ, p) → (θ, p) over a few steps, by differences: DᵀΩD = Ω. Runge-Kutta steps of the same size
    // are not symplectic.
    let model = double_pendulum();
    let defect = |method: Method| {
        let map = |x: &[f64]| {
            let M = model.mass_matrix(&x[..2]).expect("lengths");
            let dtheta = M.lu().solve(&nalgebra::DVector::from_column_slice(&x[2..])).expect("regular");
            let motion = model.simulate(&x[..2], dtheta.as_slice(), Zero, &by(method, 0.5, 0.02)).expect("a motion");
            let end = motion.last();
            let p = model.mass_matrix(end.theta).expect("lengths") * nalgebra::DVector::from_column_slice(end.dtheta);
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
    let (midpoint, euler) = (defect(Method::Midpoint), defect(Method::SemiImplicitEuler));
    assert!(midpoint < 1e-7 && euler > 1e-3, "{midpoint:e} {euler:e}");
}

/// Largest drift in the first and in the last half of a motion, over the largest kinetic energy.
fn early_and_late(model: &Model, theta: &[f64], dtheta: &[f64], options: &Options) -> [f64; 2] {
    let motion = model.simulate(theta, dtheta, Zero, options).expect("a motion");
    let (rows, K) = (motion.len(), motion.largest_kinetic_energy());
    let largest = |rows: core::ops::Range<usize>| rows.map(|k| motion.drift(k).abs()).fold(0.0, f64::max) / K;
    [largest(0..rows / 2), largest(rows / 2..rows)]
}

#[test]
fn the_midpoint_rules_energy_is_bounded() {
    let pendulum = double_pendulum();
    let options = by(Method::Midpoint, 10.0, 0.005);
    let [early, late] = early_and_late(&pendulum, &[2.0, 1.0], &[0.0; 2], &options);
    assert!(late < 2.0 * early && late < 1e-2, "{early:e} {late:e}");
    // adrift, on SE(3)
    let adrift = {
        let mut robot = floating_tree(8, 2, 0).description().clone();
        robot.joints.iter_mut().for_each(|joint| (joint.damping, joint.friction) = (0.0, 0.0));
        robot.gravity = [0.0; 3];
        robot.build().expect("sound")
    };
    let [theta, dtheta, _] = state(&adrift, 8);
    let [early, late] = early_and_late(&adrift, &theta, &dtheta, &options);
    assert!(early < 1e-3 && late < 1e-3, "{early:e} {late:e}");
    // and its momentum to rounding
    let motion = adrift.simulate(&theta, &dtheta, Zero, &options).expect("a motion");
    let momentum = |k: usize| {
        let row = motion.sample(k);
        adrift.momentum(row.theta, row.dtheta, Vec3::zero()).expect("lengths")
    };
    let lost = (0..motion.len()).map(|k| (momentum(k) - momentum(0)).norm()).fold(0.0, f64::max);
    assert!(lost < 1e-11 * momentum(0).norm(), "{lost:e}");
}

/// A million steps take seconds in release: `cargo test --release -p mozzi --lib -- --ignored million`.
#[test]
#[ignore = "a million steps"]
fn the_midpoint_rules_energy_is_bounded_over_a_million_steps() {
    let options = Options { record_every: 10, ..by(Method::Midpoint, 1000.0, 0.001) };
    let [early, late] = early_and_late(&double_pendulum(), &[2.0, 1.0], &[0.0; 2], &options);
    std::println!("drift over the largest kinetic energy: {early:.2e} in the first half, {late:.2e} in the last");
    assert!(late < 1.2 * early && late < 1e-3, "{early:e} {late:e}");
}

#[test]
fn a_slide_falls_onto_its_stop_and_is_lifted_off() {
    // 1.5 kg fall 0.2 m; at 1 s a motor begins to lift, by 10 N a second: off at 1 s + 14.715 N / 10 N/s
    let (fall, g) = (0.2, 9.81);
    let slide = single(true, Some([-fall, 5.0]));
    let lift = || torque(|t, _, _, tau| tau[0] = 10.0 * (t - 1.0).max(0.0));
    let off = 1.0 + 1.5 * g / 10.0;
    for method in [DOPRI, Method::RungeKutta4, Method::Midpoint] {
        let options = Options { joint_limits: Policy::Respect, record_every: 10, ..by(method, 3.0, 1e-3) };
        let run = Simulation::new(options).run(&slide, &[0.0], &[0.0], lift()).expect("a motion");
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
        assert!((found - expected).abs() < 1e-6, "{method:?}: {found} {expected}");
        // the energy lost in the impact is counted
        let end = run.motion.last().energy;
        assert!((end.friction_loss - 1.5 * g * fall).abs() < 1e-5 && run.motion.largest_drift() < 1e-4, "{end:?}");
    }
    let options = Options { joint_limits: Policy::Respect, ..Options::new(1.0, 100) };
    let start = slide.simulate(&[-0.3], &[0.0], Zero, &options).expect_err("beyond");
    assert!(start.to_string().contains("-0.3 of joint `pivot`, beyond its limits -0.2 … 5"), "{start}");
}

#[test]
fn stops_of_a_chain_take_energy_and_are_never_passed() {
    let mut robot = double_pendulum().description().clone();
    for joint in &mut robot.joints {
        joint.limits.position = Some([-0.6, 1.0]);
    }
    let model = robot.build().expect("sound");
    let run = |joint_limits: Policy| {
        let options = Options { joint_limits, ..by(DOPRI, 4.0, 1e-2) };
        Simulation::new(options).run(&model, &[0.9, -0.5], &[0.0; 2], Zero).expect("a motion")
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
    // as for a symmetric body: e^{[H/I] t} in space and a turn about its own axis
    let (I, I3, t, w) = (0.3, 0.5, 2.0, Vec3([0.8, -0.3, 1.5]));
    let body = SpatialInertia::new(2.0, Vec3::zero(), Sym3::diagonal(I, I, I3));
    let top = Description::new("top").link("body", body).floating().build().expect("sound");
    let start = top.neutral_configuration::<f64>();
    let options = Options { gravity: Some(Vec3::zero()), method: DOPRI, ..Options::new(t, 100) };
    let end = top.simulate(&start, &[w.0, [0.0; 3]].concat(), Zero, &options).expect("a motion");
    let turn = |w: Vec3| SE3::exp(Twist { w, v: Vec3::zero() });
    let H = Vec3([I * w.0[0], I * w.0[1], I3 * w.0[2]]);
    let expected = turn(H * (t / I)) * turn(Vec3([0.0, 0.0, (1.0 - I3 / I) * w.0[2] * t]));
    let T = SE3::from_pose(*end.last().theta.first_chunk().expect("seven"));
    assert!(distance(T, expected) < 1e-7, "{}", distance(T, expected));
}

#[test]
fn motions_that_no_step_follows_are_refused() {
    let model = double_pendulum();
    let fine = Options { method: DOPRI, ..Options::new(1.0, 100) };
    let method = Method::DormandPrince { tolerance: -1.0 };
    let error = model.simulate(&[0.0; 2], &[0.0; 2], Zero, &Options { method, ..fine }).expect_err("refused");
    assert_eq!(error.to_string(), "tolerance is -1, expected a positive, finite number");
    // too long a step for the implicit rule; a jump that no step is short enough for
    let wild = model.simulate(&[2.0, 1.0], &[9.0, -20.0], Zero, &by(Method::Midpoint, 1.0, 0.5)).expect_err("too long");
    assert!(matches!(wild, Error::NoConvergence { .. } | Error::Diverged { .. }), "{wild}");
    let jump = torque(|t, _, _, tau| tau[0] = if t > 0.3 { f64::NAN } else { 0.0 });
    assert!(model.simulate(&[0.0; 2], &[0.0; 2], jump, &fine).is_err());
    let still = Options { method: DOPRI, ..Options::new(0.0, 1) };
    let still = model.simulate(&[0.3, 0.1], &[0.0; 2], Zero, &still).expect("no motion");
    assert!(still.complete && still.last().theta == [0.3, 0.1]);
    // single steps, for many robots or for derivatives, must be explicit
    let error = model.held_step(&[0.0; 2], &[0.0; 2], &[0.0; 2], &fine).expect_err("adaptive").to_string();
    assert!(error.starts_with("the method is Dormand-Prince 5(4), expected Euler, "), "{error}");
}
