//! Robots with a floating base, simulated: compared with closed-form solutions, conservation laws and the methods'
//! orders.

extern crate std;
use crate::simulate;
use crate::{Method, Options, Zero, torque};
use alloc::vec::Vec;
use mozzi::linalg::{Sym3, Vec3};
use mozzi::testing::{distance, floating_tree, mixed_tree, state};
use mozzi::{Description, Model, SE3, SO3, SpatialInertia, Twist};

fn pose(theta: &[f64]) -> SE3 {
    SE3::from_pose(*theta.first_chunk().expect("seven"))
}

fn weightless(options: Options) -> Options {
    Options { gravity: Some(Vec3::zero()), ..options }
}

/// A body with the moments (I, I, I₃) about its centre of mass, off its frame's origin.
fn top(I: f64, I3: f64, c: Vec3) -> Model {
    let body = SpatialInertia::new(2.0, c, Sym3::diagonal(I, I, I3));
    Description::new("top").link("body", body).floating().build().expect("sound")
}

/// Friction that keeps the motion smooth, so that Runge-Kutta has its order.
fn smooth(options: Options) -> Options {
    Options { friction: crate::Friction::Smooth { slip_speed: 0.1 }, ..options }
}

#[test]
fn a_symmetric_top_turns_as_euler_says() {
    // torque-free: with H the angular momentum, e^{[H/I] t} in space and a turn by (1 − I₃/I) ω₃ t about its own axis
    let (I, I3, c, t) = (0.3, 0.5, Vec3([0.2, -0.1, 0.4]), 3.0);
    let (top, w) = (top(I, I3, c), Vec3([0.8, -0.3, 1.5]));
    let start = top.neutral_configuration::<f64>();
    let V = Twist { w, v: Vec3([0.5, 0.0, -1.0]) - w.cross(c) }; // the centre of mass at (0.5, 0, −1) m/s
    let end = simulate(&top, &start, &V.to_array(), Zero, &weightless(Options::new(t, 3000))).expect("a motion");
    let H = Vec3([I * w.0[0], I * w.0[1], I3 * w.0[2]]);
    let own = Vec3([0.0, 0.0, (1.0 - I3 / I) * w.0[2] * t]);
    let R = SO3::exp(H * (t / I)).matrix() * SO3::exp(own).matrix();
    let at = c + Vec3([0.5, 0.0, -1.0]) * t;
    let T = pose(end.last().theta);
    let expected = SE3 { R: SO3::from_matrix(R).expect("a rotation"), p: at - R * c };
    assert!(distance(T, expected) < 1e-11, "{}", distance(T, expected));
    assert!(end.largest_drift() < 1e-12);
}

#[test]
fn the_centre_of_mass_falls_on_a_parabola_whatever_the_joints_do() {
    let model = floating_tree(21, 7, 1);
    let [theta, dtheta, _] = state(&model, 3);
    let motors = || {
        torque(|t, theta, dtheta, tau| (6..tau.len()).for_each(|j| tau[j] = 4.0 * t - theta[j + 1] - 0.3 * dtheta[j]))
    };
    let t = 0.4;
    let fall = simulate(&model, &theta, &dtheta, motors(), &smooth(Options::new(t, 2000))).expect("a motion");
    let c = |theta: &[f64]| model.center_of_mass(theta).expect("a mass");
    let expected = c(&theta)
        + model.center_of_mass_velocity(&theta, &dtheta).expect("a mass") * t
        + model.gravity() * (0.5 * t * t);
    assert!((c(fall.last().theta) - expected).norm() < 1e-10, "{:?} {expected:?}", c(fall.last().theta));
}

#[test]
fn every_method_keeps_its_order_on_the_group() {
    keeps_order(&floating_tree(4, 5, 0));
    keeps_order(&mixed_tree(4, 5, 0));
}

fn keeps_order(model: &Model) {
    let [theta, dtheta, _] = state(model, 6);
    let end = |method, steps| {
        let friction = crate::Friction::Smooth { slip_speed: 0.5 };
        let options = Options { method, friction, record_every: steps, ..Options::new(0.1, steps) };
        let end = simulate(model, &theta, &dtheta, Zero, &options).expect("a motion");
        [end.last().theta, end.last().dtheta].concat()
    };
    let best = end(Method::RungeKutta4, 4000);
    for (method, steps) in [(Method::Euler, 400), (Method::SemiImplicitEuler, 400), (Method::RungeKutta4, 50)] {
        let error = |steps| {
            let found = end(method, steps);
            found.iter().zip(&best).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
        };
        let order = (error(steps) / error(2 * steps)).log2();
        std::println!("{:20} {order:.2}", method.name());
        assert!((order - f64::from(method.order())).abs() < 0.3, "{}: {order}", method.name());
    }
}

/// A tumbling robot's momentum is kept to rounding, its quaternion's length too; the energy's drift is printed.
#[test]
fn a_tumbling_robot_keeps_its_momentum() {
    let model = floating_tree(8, 4, 0);
    let [theta, dtheta, _] = state(&model, 8);
    let dtheta: Vec<f64> = dtheta.iter().map(|x| 0.3 * x).collect();
    let momentum = |theta: &[f64], dtheta: &[f64]| model.momentum(theta, dtheta, Vec3::zero()).expect("lengths");
    let before = momentum(&theta, &dtheta);
    for (steps, bound) in [(100_000, 1e-11), (10_000, 1e-9)] {
        let options = smooth(weightless(Options { record_every: steps / 10, ..Options::new(10.0, steps) }));
        let tumble = simulate(&model, &theta, &dtheta, Zero, &options).expect("a motion");
        let lost = tumble.samples().map(|s| (momentum(s.theta, s.dtheta) - before).norm() / before.norm());
        let lost = lost.fold(0.0, f64::max);
        let length: f64 = tumble.last().theta[..4].iter().map(|x| x * x).sum();
        let energy = tumble.largest_drift() / tumble.largest_kinetic_energy();
        std::println!("{steps} steps: momentum {lost:.1e}, energy {energy:.1e}");
        assert!(lost < bound && (length - 1.0).abs() < 1e-15, "{steps} steps: {lost:e} {length}");
    }
}

#[test]
fn motors_against_gravity_leave_a_free_base_to_fall() {
    let model = floating_tree(30, 5, 1);
    let [theta, _, _] = state(&model, 2);
    let still = std::vec![0.0; model.n()];
    let motors = crate::GravityCompensation::new(&model);
    let fall = simulate(&model, &theta, &still, motors, &smooth(Options::new(0.1, 100))).expect("a motion");
    assert_eq!(fall.tau[..6], [0.0; 6]);
    let (start, end) = (model.center_of_mass(&theta), model.center_of_mass(fall.last().theta));
    let fallen = end.expect("a mass") - start.expect("a mass");
    assert!((fallen - model.gravity() * 0.005).norm() < 1e-9, "{fallen:?}");
}
