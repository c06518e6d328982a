//! Closed loops stay closed along motions.

use super::robots::swing;
use crate::{Method, Options, Policy, Simulation, Zero, simulate, step_sensitivity, torque};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::constraints::constraint_jacobian;
use mozzi::model::description::{Anchor, Constraint, Joint};
use mozzi::testing::four_bar;
use mozzi::{Description, Model, SE3, SO3, SpatialInertia, Sym3, Vec3, Workspace};

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

/// A loop open by half a turn is refused by one motion, and by a step's derivatives, whose kernel reads 0 there.
#[test]
fn a_start_open_by_half_a_turn_is_refused() {
    let turned = SE3::new(SO3::exp(Vec3([0.0, core::f64::consts::PI, 0.0])), Vec3::zero());
    let mut robot = Description::new("pendulum").link("base", SpatialInertia::zero());
    robot = robot.link("bob", SpatialInertia::point_mass(2.0, Vec3([0.0, 0.0, -0.7])));
    robot = robot.joint(Joint::new("pivot", "base", "bob", SE3::identity(), swing()));
    robot.constraints = vec![Constraint::weld("loop", Anchor::world(turned), "bob")];
    let model = robot.build().expect("sound");
    let options = Options::new(0.01, 10);
    let one = simulate(&model, &[0.0], &[0.0], Zero, &options).expect_err("open");
    let step = step_sensitivity(&model, &[0.0], &[0.0], &[0.0], &options, &[]).expect_err("open");
    for error in [one, step] {
        assert!(error.to_string().contains("violates constraint `loop`"), "{error}");
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
    assert!(motion.largest_drift() < 1e-9 && motion.last().energy.motor_work > 0.0, "{:e}", motion.largest_drift());
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

/// A parallelogram passes its flat pose, where it could go on crossed: on the same branch by every method, or an error.
#[test]
fn a_change_point_is_no_jump() {
    let rod = |r: Vec3| SpatialInertia::new(1.0, r * 0.5, Sym3::diagonal(0.01, 0.02, 0.02));
    let at = |x: f64| SE3::translation([x, 0.0, 0.0]);
    let mut robot = Description::new("parallelogram").link("base", SpatialInertia::zero());
    let (up, across) = (Vec3([0.0, 0.0, 0.3]), Vec3([0.5, 0.0, 0.0]));
    robot = robot.link("a", rod(up)).link("b", rod(across)).link("c", rod(up));
    robot = robot.joint(Joint { damping: 0.05, ..Joint::new("j1", "base", "a", at(0.0), swing()) });
    robot = robot.joint(Joint::new("j2", "a", "b", SE3::translation(up.0), swing()));
    robot = robot.joint(Joint::new("j3", "base", "c", at(0.5), swing()));
    let pin = [Anchor::frame("b").at(at(0.5)), Anchor::frame("c").at(SE3::translation(up.0))];
    robot.constraints = vec![Constraint::point("k", pin[0].clone(), pin[1].clone())];
    let model = robot.build().expect("sound");
    let dtheta = model.assemble_velocities(&[0.0; 3], &[1.0, 0.0, 0.0], &["j1"]).expect("moves");
    for method in
        [Method::RungeKutta4, Method::Midpoint, Method::SemiImplicitEuler, Method::DormandPrince { tolerance: 1e-8 }]
    {
        let options = Options { method, ..Options::new(1.5, 1500) };
        match simulate(&model, &[0.0; 3], &dtheta, Zero, &options) {
            Ok(motion) => {
                let [a, b, c] = [0, 1, 2].map(|k| motion.last().theta[k]);
                assert!((a + b).abs() < 1e-6 && (a - c).abs() < 1e-6, "{}: {a} {b} {c}", method.name());
                assert!(a.abs() > 2.0, "{}: {a} passes no flat pose", method.name());
            }
            Err(error) => {
                let reasons = ["passes a change point", "did not converge", "the energy is off"];
                let is_named = reasons.iter().any(|reason| error.to_string().contains(reason));
                assert!(is_named && method == Method::Midpoint, "{}: {error}", method.name());
            }
        }
    }
}
