//! Robots with balls and free joints: closed-form solutions, conservation laws, orders.

extern crate std;
use crate::simulate;
use crate::{Friction, Method, Options, Zero};
use alloc::vec;
use mozzi::model::description::{Joint, JointKind};
use mozzi::model::difference;
use mozzi::testing::{inertia, mixed_tree, state};
use mozzi::{Description, Model, SE3, SO3, SpatialInertia, Sym3, Twist, Vec3};
use nalgebra::DVector;

fn joint(name: &str, parent: &str, child: &str, kind: JointKind) -> Joint {
    Joint::new(name, parent, child, SE3::exp(Twist::from_array([0.3, -0.2, 0.5, 0.1, 0.4, -0.3])), kind)
}

/// Two free bodies, one of which carries a limb on a ball; no gravity.
fn adrift() -> Model {
    let robot = Description::new("adrift")
        .link("world", SpatialInertia::zero())
        .link("trunk", inertia(1))
        .link("limb", inertia(2) * 0.3)
        .link("stone", inertia(3))
        .joint(joint("fly", "world", "trunk", JointKind::Free))
        .joint(joint("hip", "trunk", "limb", JointKind::Ball(Vec3([0.2, 0.1, -0.3]))))
        .joint(joint("fall", "world", "stone", JointKind::Free));
    robot.with_gravity([0.0; 3]).build().expect("sound")
}

/// A chain of two balls.
fn chain() -> Model {
    let robot = Description::new("chain")
        .link("base", SpatialInertia::zero())
        .link("upper", inertia(4))
        .link("lower", inertia(5))
        .joint(joint("shoulder", "base", "upper", JointKind::Ball(Vec3([0.5, 0.0, 0.0]))))
        .joint(joint("elbow", "upper", "lower", JointKind::Ball(Vec3([0.0, 0.4, 0.0]))));
    robot.build().expect("sound")
}

/// Largest drift of the energy in the first and in the last half, over the largest kinetic energy.
fn early_and_late(model: &Model, steps: usize, step: f64) -> [f64; 2] {
    let [theta, dtheta, _] = state(model, 3);
    let options = Options { method: Method::Midpoint, record_every: 10, ..Options::new(steps as f64 * step, steps) };
    let motion = simulate(model, &theta, &dtheta, Zero, &options).expect("a motion");
    let (rows, K) = (motion.len(), motion.largest_kinetic_energy());
    let largest = |rows: core::ops::Range<usize>| rows.map(|k| motion.drift(k).abs()).fold(0.0, f64::max) / K;
    [largest(0..rows / 2), largest(rows / 2..rows)]
}

#[test]
fn the_midpoint_rules_energy_has_no_trend() {
    for model in [chain(), adrift()] {
        let [early, late] = early_and_late(&model, 4000, 0.002);
        std::println!("{}: {early:.2e} {late:.2e}", model.description().name);
        assert!(late < 3.0 * early && late < 1e-3, "{early:e} {late:e}");
    }
}

/// Takes ten seconds in release: `cargo test --release -p mozzi --lib -- --ignored hundred_thousand --nocapture`.
#[test]
#[ignore = "a hundred thousand steps"]
fn the_midpoint_rules_energy_has_no_trend_over_a_hundred_thousand_steps() {
    for model in [chain(), adrift()] {
        let [early, late] = early_and_late(&model, 100_000, 0.002);
        std::println!("{}: {early:.2e} in the first half, {late:.2e} in the last", model.description().name);
        assert!(late < 1.5 * early && late < 1e-3, "{early:e} {late:e}");
    }
}

#[test]
fn free_bodies_keep_their_momentum_to_rounding() {
    let model = adrift();
    let [theta, dtheta, _] = state(&model, 5);
    let options = Options { method: Method::Midpoint, record_every: 10, ..Options::new(10.0, 2000) };
    let motion = simulate(&model, &theta, &dtheta, Zero, &options).expect("a motion");
    let momentum = |k: usize| {
        let row = motion.sample(k);
        model.momentum(row.theta, row.dtheta, Vec3::zero()).expect("lengths")
    };
    let lost = (0..motion.len()).map(|k| (momentum(k) - momentum(0)).norm()).fold(0.0, f64::max);
    std::println!("momentum lost: {:.1e} of it", lost / momentum(0).norm());
    assert!(lost < 1e-11 * momentum(0).norm(), "{lost:e}");
}

#[test]
fn a_top_on_a_ball_turns_as_euler_says() {
    // torque-free about its centre: e^{[H/I] t}, and a turn by (1 − I₃/I) ω₃ t about its own axis
    let (I, I3, t, w) = (0.3, 0.5, 3.0, Vec3([0.8, -0.3, 1.5]));
    let c = Vec3([0.1, 0.2, -0.3]);
    let top = Description::new("top")
        .link("base", SpatialInertia::zero())
        .link("top", SpatialInertia::new(2.0, c, Sym3::diagonal(I, I, I3)))
        .joint(Joint::new("ball", "base", "top", SE3::identity(), JointKind::Ball(c)))
        .build()
        .expect("sound");
    let R = SO3::exp(Vec3([I * w.0[0], I * w.0[1], I3 * w.0[2]]) * (t / I)).matrix()
        * SO3::exp(Vec3([0.0, 0.0, (1.0 - I3 / I) * w.0[2] * t])).matrix();
    let expected = SE3 { R: SO3::from_matrix(R).expect("a rotation"), p: Vec3::zero() }.to_pose();
    let adaptive = Method::DormandPrince { tolerance: 1e-11 };
    for (method, bound) in [(adaptive, 1e-9), (Method::RungeKutta4, 1e-9), (Method::Midpoint, 1e-5)] {
        let options = Options { method, ..Options::new(t, 3000) };
        let motion = simulate(&top, &[1.0, 0.0, 0.0, 0.0], &w.0, Zero, &options).expect("a motion");
        let mut way = [0.0; 3];
        difference(&top, &expected[..4], motion.last().theta, &mut way);
        assert!(Vec3(way).norm() < bound, "{}: {:e}", method.name(), Vec3(way).norm());
    }
}

#[test]
fn orders_on_the_group() {
    let model = mixed_tree(4, 5, 0);
    assert!(!model.configuration_space().is_flat());
    let [theta, dtheta, _] = state(&model, 6);
    let friction = Friction::Smooth { slip_speed: 0.5 };
    let best = Options { friction, record_every: 4000, ..Options::new(0.05, 4000) };
    let best = simulate(&model, &theta, &dtheta, Zero, &best).expect("a motion");
    let error = |method, steps| {
        let options = Options { method, friction, ..Options::new(0.05, steps) };
        let motion = simulate(&model, &theta, &dtheta, Zero, &options).expect("a motion");
        let mut way = vec![0.0; model.n()];
        difference(&model, best.last().theta, motion.last().theta, &mut way);
        DVector::from_vec(way).amax()
    };
    let order = |method, steps| (error(method, steps) / error(method, 2 * steps)).log2();
    let (midpoint, runge_kutta) = (order(Method::Midpoint, 50), order(Method::RungeKutta4, 10));
    std::println!("midpoint {midpoint:.2}, Runge-Kutta {runge_kutta:.2}");
    assert!((midpoint - 2.0).abs() < 0.2 && (runge_kutta - 4.0).abs() < 0.4, "{midpoint} {runge_kutta}");
    assert!(error(Method::DormandPrince { tolerance: 1e-11 }, 10) < 1e-8);
}
