//! Closed loops stay closed along motions.

use crate::{Method, Options, Policy, Simulation, Zero, simulate, torque};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::constraints::constraint_jacobian;
use mozzi::testing::four_bar;
use mozzi::{Model, Workspace};

const GUESS: [f64; 3] = [1.0, -0.6, 1.6];

/// The largest |φ| and |A θ̇|.
fn gaps(model: &Model, theta: &[f64], dtheta: &[f64]) -> [f64; 2] {
    let (m, n) = (model.constraint_rows(), model.n());
    let (mut A, mut phi) = (vec![0.0; m * n], vec![0.0; m]);
    constraint_jacobian(model, theta, dtheta, &mut Workspace::new(model), &mut A, &mut [], &mut phi);
    let speed = |row: &[f64]| row.iter().zip(dtheta).map(|(a, b)| a * b).sum::<f64>();
    let largest = |list: &mut dyn Iterator<Item = f64>| list.fold(0.0, |most: f64, x| most.max(x.abs()));
    [largest(&mut phi.iter().copied()), largest(&mut A.chunks(n).map(speed))]
}

fn closed_four_bar() -> (Model, Vec<f64>, Vec<f64>) {
    let model = four_bar();
    let theta = model.assemble(&GUESS, &["crank_pivot"]).expect("closes");
    let dtheta = model.assemble_velocities(&theta, &[1.5, 0.0, 0.0], &["crank_pivot"]).expect("moves");
    (model, theta, dtheta)
}

#[test]
fn a_four_bar_keeps_its_energy_and_stays_closed() {
    let (model, theta, dtheta) = closed_four_bar();
    let methods = [
        (Method::RungeKutta4, 1e-6),
        (Method::DormandPrince { tolerance: 1e-9 }, 1e-6),
        (Method::Midpoint, 2e-3),
        (Method::SemiImplicitEuler, 0.3),
    ];
    for (method, drift) in methods {
        let options = Options { method, record_every: 100, ..Options::new(2.0, 2000) };
        let run = Simulation::new(options).run(&model, &theta, &dtheta, Zero).expect("a motion");
        assert!(run.motion.largest_drift() < drift, "{}: {}", method.name(), run.motion.largest_drift());
        assert!(run.closing.residual < 1e-14, "{}: {:?}", method.name(), run.closing);
        for sample in run.motion.samples() {
            let [phi, speed] = gaps(&model, sample.theta, sample.dtheta);
            assert!(phi < 1e-13 && speed < 1e-12, "{phi} {speed}");
        }
    }
}

#[test]
fn an_open_start_is_refused_and_a_motor_turns_the_crank() {
    let (model, theta, dtheta) = closed_four_bar();
    let options = Options { record_every: 50, ..Options::new(0.5, 500) };
    let error = simulate(&model, &GUESS, &[0.0; 3], Zero, &options).expect_err("open");
    assert!(error.to_string().contains("violates constraint `loop`"), "{error}");
    let error = simulate(&model, &theta, &[1.0, 1.0, 1.0], Zero, &options).expect_err("cannot move so");
    assert!(error.to_string().contains("a velocity that violates constraint `loop`"), "{error}");
    let push = torque(|_, _, _, tau: &mut [f64]| tau[0] = 0.3);
    let motion = simulate(&model, &theta, &dtheta, push, &options).expect("a motion");
    assert!(motion.largest_drift() < 1e-9 && motion.last().energy.motor_work > 0.0);
}

#[test]
fn a_four_bar_stops_at_the_limit_of_its_rocker() {
    let (model, theta, dtheta) = closed_four_bar();
    let mut robot = model.description().clone();
    let rocker = robot.joints.iter_mut().find(|joint| joint.name == "rocker_pivot").expect("there");
    rocker.limits.position = Some([theta[2] - 0.1, theta[2] + 0.1]);
    let model = robot.build().expect("sound");
    let options = Options { joint_limits: Policy::Respect, record_every: 10, ..Options::new(1.0, 1000) };
    let run = Simulation::new(options).run(&model, &theta, &dtheta, Zero).expect("a motion");
    assert!(!run.stops.is_empty() && run.stops.iter().all(|stop| stop.joint == "rocker_pivot"), "{:?}", run.stops);
    let mut energy = f64::INFINITY;
    for sample in run.motion.samples() {
        let [phi, speed] = gaps(&model, sample.theta, sample.dtheta);
        assert!(phi < 1e-9 && speed < 1e-9, "{phi} {speed} at {}", sample.t);
        assert!((sample.theta[2] - theta[2]).abs() < 0.1 + 1e-9, "{} at {}", sample.theta[2], sample.t);
        let now = sample.energy.kinetic + sample.energy.potential;
        assert!(now < energy + 1e-4, "{now} {energy}");
        energy = now;
    }
    // an impact is located to a step
    assert!(run.motion.largest_drift() < 1e-2, "{}", run.motion.largest_drift());
}

#[test]
fn a_hundred_thousand_steps_leave_the_loop_closed() {
    let (model, theta, dtheta) = closed_four_bar();
    let options = Options { record_every: 10_000, ..Options::new(100.0, 100_000) };
    let run = Simulation::new(options).run(&model, &theta, &dtheta, Zero).expect("a motion");
    assert!(run.closing.residual < 1e-13, "{:?}", run.closing);
    let at_10_s = (0..run.motion.len()).find(|&k| run.motion.t[k] >= 10.0).expect("recorded");
    assert!(run.motion.drift(at_10_s).abs() < 1e-6, "{}", run.motion.drift(at_10_s));
}
