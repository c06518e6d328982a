//! What `simulate` promises.

use super::robots::{INERTIA, difference, double_pendulum, pendulum};
use crate::*;
use alloc::vec::Vec;
use core::f64::consts::PI;
use core::ops::ControlFlow;
use mozzi::model::description::Joint;
use mozzi::{Description, SpatialInertia, Wrench, testing};

/// T = 2π √(l/g) / agm(1, cos(θ₀/2)), exactly.
fn period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    2.0 * PI * (0.7_f64 / 9.81).sqrt() / a
}

#[test]
fn a_pendulum_keeps_its_exact_period() {
    for amplitude in [0.1, 1.0, 3.0] {
        let T = period(amplitude);
        let options = Options { record_every: 500, ..Options::new(T, 2000) };
        let swing = simulate(&pendulum(0.0, 0.0), &[amplitude], &[0.0], Zero, &options).expect("a motion");
        let angles = [amplitude, 0.0, -amplitude, 0.0, amplitude];
        assert!(difference(&swing.theta, &angles) < 1e-9, "{:?}", swing.theta);
        // at the bottom all energy is kinetic: ½ I θ̇² = m g l (1 − cos θ₀)
        let bottom = (2.0 * 2.0 * 9.81 * 0.7 * (1.0 - amplitude.cos()) / INERTIA).sqrt();
        assert!(difference(&swing.dtheta, &[0.0, -bottom, 0.0, bottom, 0.0]) < 1e-9);
    }
}

#[test]
fn what_is_recorded() {
    let robot = double_pendulum();
    let start = ([0.4, -0.2], [0.1, 0.3]);
    let every = simulate(&robot, &start.0, &start.1, Zero, &Options::new(1.0, 10)).expect("a motion");
    assert!(every.complete && every.steps == 10 && every.len() == 11);
    let options = Options { record_every: 4, ..Options::new(1.0, 10) };
    let some = simulate(&robot, &start.0, &start.1, Zero, &options).expect("a motion");
    assert_eq!(some.t, [0.0, 0.4, 0.8, 1.0]);
    for (sample, k) in some.samples().zip([0, 4, 8, 10]) {
        assert_eq!(sample, every.sample(k));
    }
    // energies against the methods of the model
    for sample in every.samples() {
        let K = robot.kinetic_energy(sample.theta, sample.dtheta).expect("lengths");
        let P = robot.potential_energy(sample.theta).expect("lengths");
        assert_eq!((sample.energy.kinetic, sample.energy.potential), (K, P));
    }
    let still = simulate(&robot, &start.0, &start.1, Zero, &Options::new(0.0, 1)).expect("no motion");
    assert_eq!(still.len(), 1);
    assert_eq!(still.last().theta, start.0);
}

#[test]
fn progress_is_called_after_each_step_and_can_stop() {
    let (robot, simulation) = (pendulum(0.0, 0.0), Simulation::new(Options::new(1.0, 1000)));
    let run = |most: usize| {
        let mut times = Vec::new();
        let run = simulation.run_with_progress(&robot, &[1.0], &[0.0], Zero, |t| {
            times.push(t);
            if times.len() == most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (run.expect("a motion").motion, times)
    };
    let (whole, times) = run(usize::MAX);
    assert!(whole.complete && times == whole.t[1..]);
    let (stopped, _) = run(300);
    assert!(!stopped.complete && stopped.steps == 300 && stopped.last().t == 0.3);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let robot = double_pendulum();
    let fine = Options::new(1.0, 10);
    let run = |theta: &[f64], dtheta: &[f64], options: &Options| simulate(&robot, theta, dtheta, Zero, options);
    assert!(matches!(
        run(&[0.0], &[0.0; 2], &fine),
        Err(Error::Model(mozzi::Error::WrongLength { what: "theta", found: 1, .. }))
    ));
    assert!(matches!(
        run(&[0.0; 2], &[0.0; 3], &fine),
        Err(Error::Model(mozzi::Error::WrongLength { what: "dtheta", found: 3, .. }))
    ));
    let bad = |theta: &[f64], options: Options| match run(theta, &[0.0; 2], &options) {
        Err(Error::Model(mozzi::Error::BadArgument { what, .. })) => what,
        other => panic!("{other:?}"),
    };
    assert_eq!(bad(&[0.0, f64::NAN], fine), "theta");
    assert_eq!(bad(&[0.0; 2], Options { steps: 0, ..fine }), "steps");
    assert_eq!(bad(&[0.0; 2], Options { record_every: 0, ..fine }), "record_every");
    assert_eq!(bad(&[0.0; 2], Options { gravity: Some(mozzi::Vec3([0.0, f64::NAN, 0.0])), ..fine }), "gravity");
    for duration in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(bad(&[0.0; 2], Options { duration, ..fine }), "duration");
    }
    for slip_speed in [0.0, -1.0, f64::NAN] {
        assert_eq!(bad(&[0.0; 2], Options { friction: Friction::Smooth { slip_speed }, ..fine }), "slip_speed");
    }
    let nan = simulate(&robot, &[0.0; 2], &[0.0; 2], torque(|_, _, _, tau| tau[1] = f64::NAN), &fine);
    let message = nan.expect_err("NaN").to_string();
    assert!(message.contains("the input's torque") && message.contains("joint2"), "{message}");
    let tip = robot.frame("rod2").expect("there");
    let nan = simulate(&robot, &[0.0; 2], &[0.0; 2], applied(tip, |_, _, _| Wrench::zero() * f64::NAN), &fine);
    assert!(nan.expect_err("NaN").to_string().contains("frame `rod2`"));
    let other = testing::tree(1, 9, 0).end_effector().expect("named");
    assert!(simulate(&robot, &[0.0; 2], &[0.0; 2], applied(other, |_, _, _| Wrench::zero()), &fine).is_err());
}

/// The tolerance of positions is absolute: a pendulum that has turned 10⁴ times swings like one that has not.
#[test]
fn turns_do_not_loosen_the_tolerance() {
    let options = Options { method: Method::DormandPrince { tolerance: 1e-8 }, ..Options::new(10.0, 1) };
    let turns = 1e4 * 2.0 * PI;
    let swing = |start: f64| {
        let motion = simulate(&pendulum(0.0, 0.0), &[start], &[0.0], Zero, &options).expect("a motion");
        motion.last().theta[0]
    };
    let apart = (swing(1.0 + turns) - turns - swing(1.0)).abs();
    assert!(apart < 1e-6, "{apart:e}");
}

#[test]
fn a_blow_up_is_named() {
    // a spring too stiff for the step: explicit Euler multiplies its amplitude by 300 a step
    let spring = |_: f64, theta: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = -1e9 * theta[0];
    let options = Options { method: Method::Euler, ..Options::new(10.0, 1000) };
    let error = simulate(&pendulum(0.0, 0.0), &[1.0], &[0.0], torque(spring), &options).expect_err("too stiff");
    let Error::Diverged { joint, step, time, step_size, value, .. } = &error else { panic!("{error:?}") };
    assert!(joint == "pivot" && value.abs() > 1e150 && *step_size == 0.01);
    assert!(*step > 50 && *step < 75 && (time - *step as f64 * 0.01).abs() < 1e-9, "{error}");
    assert!(error.to_string().contains("a smaller step may help"));
}

#[test]
fn a_position_that_is_nowhere_is_named() {
    let robot = testing::floating_tree(1, 3, 0);
    for (index, expected) in [(6, "joint `base.z`"), (robot.nq() - 1, "joint `joint")] {
        let mut theta = testing::state(&robot, 1)[0].clone();
        theta[index] = 1e151;
        let error = simulate(&robot, &theta, &vec![0.0; robot.n()], Zero, &Options::new(1.0, 10)).expect_err("nowhere");
        assert!(error.to_string().contains(&format!("theta of {expected}")), "{error}");
    }
}

#[test]
fn a_singular_mass_matrix_is_named() {
    let kind = pendulum(0.0, 0.0).joints().next().expect("one").kind;
    let robot = Description::new("massless")
        .link("base", SpatialInertia::zero())
        .link("ghost", SpatialInertia::zero())
        .joint(Joint::new("hinge", "base", "ghost", mozzi::SE3::identity(), kind));
    let error = simulate(&robot.build().expect("sound"), &[0.0], &[0.0], Zero, &Options::new(1.0, 10));
    assert!(matches!(error, Err(Error::Model(mozzi::Error::SingularMassMatrix { joint, .. })) if joint == "hinge"));
}
