//! Joints at their limits, with limits respected: closed-form solutions and energy.

extern crate std;
use crate::simulate;
use crate::{Method, Options, Policy, Run, Simulation, Zero, torque};
use alloc::string::ToString;
use alloc::vec::Vec;
use mozzi::model::Bounds;
use mozzi::model::description::{Joint, JointKind};
use mozzi::testing::{inertia, state};
use mozzi::{Description, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Vec3};

/// The method of stops, and how far impacts within a step of 1 ms may be off.
const METHODS: [(Method, f64); 1] = [(Method::Automatic, 3e-3)];
/// A limit may be exceeded by this much: rounding.
const ROUNDING: f64 = 1e-10;

fn ball(child: &str, parent: &str, center: [f64; 3], limit: f64) -> Joint {
    let kind = JointKind::Ball(Vec3(center));
    let mut joint = Joint::new(std::format!("ball of {child}"), parent, child, SE3::identity(), kind);
    joint.limits.position = Some([0.0, limit]);
    joint
}

/// A body on a ball.
fn top(body: SpatialInertia, limit: f64) -> Model {
    let robot = Description::new("top").link("base", SpatialInertia::zero()).link("top", body);
    robot.joint(ball("top", "base", [0.0; 3], limit)).build().expect("sound")
}

fn run(model: &Model, theta: &[f64], dtheta: &[f64], method: Method, duration: f64) -> Run {
    let options =
        Options { method, joint_limits: Policy::Respect, ..Options::with_step(duration, 1e-3).expect("fits") };
    Simulation::new(options).run(model, theta, dtheta, Zero).expect("a motion")
}

/// No joint exceeds its limit, and without motors no stop adds energy.
fn check_limits_and_energy(model: &Model, run: &Run, tolerance: f64) {
    let bounds = Bounds::of(model);
    let size = run.motion.largest_kinetic_energy();
    let mut least = f64::INFINITY;
    for row in run.motion.samples() {
        for (k, &[low, high]) in bounds.joints.iter().enumerate() {
            let value = bounds.value(row.theta, k);
            assert!(
                (low - ROUNDING..=high + ROUNDING).contains(&value),
                "{}: joint {k} is at {value} of {low} … {high}",
                row.t
            );
        }
        let energy = row.energy.kinetic + row.energy.potential;
        assert!(energy <= least + tolerance * size, "{}: {energy} after {least}", row.t);
        least = least.min(energy);
    }
    assert!(run.stops.iter().all(|stop| stop.beyond == 0.0), "{:?}", run.stops);
    let drift = run.motion.largest_drift();
    assert!(drift < tolerance * size, "{drift:e} of {size}");
}

#[test]
fn a_sphere_on_a_ball_slides_along_its_cone() {
    // ω is constant until ‖φ‖ = α; then φ/‖φ‖ moves on a great circle by ‖ω − nnᵀω‖/(2 sin(α/2)) a second
    let (limit, duration) = (0.9_f64, 2.0);
    let model = top(SpatialInertia::new(2.0, Vec3::zero(), Sym3::diagonal(0.3, 0.3, 0.3)), limit);
    let (turn, w) = (Vec3([0.2, -0.3, 0.1]), Vec3([0.8, 0.4, -0.5]));
    let (q0, v0) = SO3::exp(turn).quaternion();
    // cos(‖φ‖/2) = q₀ cos(‖ω‖t/2) − v₀ᵀω/‖ω‖ sin(‖ω‖t/2) = cos(α/2)
    let (a, b): (f64, f64) = (q0, -v0.dot(w) * (1.0 / w.norm()));
    let impact = 2.0 / w.norm() * (b.atan2(a) + ((0.5 * limit).cos() / a.hypot(b)).acos());
    let n = (SO3::exp(turn) * SO3::exp(w * impact)).log() * (1.0 / limit);
    let (along, across) = (n.dot(w), w - n * n.dot(w));
    let cot = 1.0 / (0.5 * limit).tan();
    let rate = (across * cot + n.cross(across)) * 0.5; // ṅ
    assert!((rate.norm() - across.norm() / (2.0 * (0.5 * limit).sin())).abs() < 1e-14);
    let angle = rate.norm() * (duration - impact);
    let expected = (n * angle.cos() + rate * (angle.sin() / rate.norm())) * limit;

    for sign in [1.0, -1.0] {
        let start = [q0, v0.0[0], v0.0[1], v0.0[2]].map(|x| sign * x);
        for (method, bound) in METHODS {
            let run = run(&model, &start, &w.0, method, duration);
            let [stop] = &run.stops[..] else { panic!("{:?}", run.stops) };
            assert!((stop.first - impact).abs() < bound && stop.times == 1, "{stop:?}, expected {impact}");
            let q = run.motion.last().theta;
            let phi = SO3::from_quaternion(q[0], Vec3([q[1], q[2], q[3]])).log();
            assert!((phi - expected).norm() < bound, "{}: {:e}", method.name(), (phi - expected).norm());
            let lost = run.motion.last().energy.friction_loss;
            assert!((lost - 0.15 * along * along).abs() < bound, "{lost}");
            check_limits_and_energy(&model, &run, 10.0 * bound);
        }
    }
}

#[test]
fn a_pendulum_on_a_ball_is_thrown_against_its_cone() {
    // with spin, from inside the cone; it rests against it, leaves it as it falls back, and comes again
    let body = SpatialInertia::new(1.5, Vec3([0.0, 0.0, -0.5]), Sym3::diagonal(0.4, 0.45, 0.1));
    let model = top(body, 0.7);
    for (method, bound) in METHODS {
        let run = run(&model, &[0.15_f64.cos(), 0.15_f64.sin(), 0.0, 0.0], &[0.5, 2.5, 0.8], method, 4.0);
        std::println!("{:?}", run.stops);
        let [stop] = &run.stops[..] else { panic!("{:?}", run.stops) };
        assert!(stop.times >= 2 && stop.limit == 0.7, "{}: {stop:?}", method.name());
        let at_limit = |theta: &[f64]| Bounds::of(&model).value(theta, 0) > 0.7 - 1e-9;
        let rows: Vec<bool> = run.motion.samples().map(|row| at_limit(row.theta)).collect();
        let turns = rows.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(turns >= 3, "{}: comes and goes {turns} times", method.name());
        check_limits_and_energy(&model, &run, 10.0 * bound);
    }
}

#[test]
fn a_chain_of_balls_and_a_hinge_keeps_all_its_limits() {
    let mut hinge = Joint::new(
        "hinge",
        "upper",
        "lower",
        SE3::translation([0.0, 0.0, -0.4]),
        JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("unit")),
    );
    hinge.limits.position = Some([-0.4, 0.5]);
    let mut hand = ball("hand", "lower", [0.0; 3], 0.5);
    hand.origin = SE3::translation([0.1, 0.0, -0.3]);
    let model = Description::new("chain")
        .link("base", SpatialInertia::zero())
        .link("upper", inertia(4))
        .link("lower", inertia(5))
        .link("hand", inertia(6) * 0.3)
        .joint(ball("upper", "base", [0.0; 3], 0.8))
        .joint(hinge)
        .joint(hand)
        .build()
        .expect("sound");
    let theta = model.neutral_configuration::<f64>();
    let [_, dtheta, _] = state(&model, 3);
    for (method, bound) in METHODS {
        let run = run(&model, &theta, &dtheta, method, 1.0);
        assert!(run.stops.len() >= 2, "{:?}", run.stops);
        check_limits_and_energy(&model, &run, 100.0 * bound);
    }
}

#[test]
fn a_ball_near_a_half_turn_does_not_pass_to_the_other_side() {
    let model = top(SpatialInertia::new(2.0, Vec3::zero(), Sym3::diagonal(0.3, 0.3, 0.3)), 3.13);
    // 0.0232 rad beyond the limit it would be within it again: two steps
    let run = run(&model, &[1.0, 0.0, 0.0, 0.0], &[0.0, 0.0, 9.0], Method::Automatic, 0.5);
    assert_eq!(run.stops.len(), 1);
    check_limits_and_energy(&model, &run, 1e-8);
}

/// Two slides of 1 kg along z, side by side.
fn slides(limits: [f64; 2]) -> Model {
    let robot = ["left", "right"].iter().fold(
        Description::new("slides").link("base", SpatialInertia::zero()),
        |robot, name| {
            let axis = JointKind::Screw(ScrewAxis::new([0.0; 3], [0.0, 0.0, 1.0]).expect("unit"));
            let mut joint = Joint::new(std::format!("{name} slide"), "base", *name, SE3::identity(), axis);
            joint.limits.position = Some(limits);
            robot.link(*name, SpatialInertia::point_mass(1.0, Vec3::zero())).joint(joint)
        },
    );
    robot.build().expect("sound")
}

#[test]
fn joints_that_come_to_their_stops_at_the_same_time_both_stop() {
    let model = slides([-0.2, 5.0]);
    for (method, bound) in METHODS {
        let run = run(&model, &[0.0; 2], &[0.0; 2], method, 1.0);
        assert_eq!(run.stops.len(), 2, "{:?}", run.stops);
        check_limits_and_energy(&model, &run, 10.0 * bound);
        assert_eq!(run.motion.last().theta, [-0.2; 2]);
    }
}

#[test]
fn joints_that_start_at_their_stops_stay_there() {
    let model = slides([-0.2, 5.0]);
    for (method, bound) in METHODS {
        // at rest, and moving towards the stop
        let run = run(&model, &[-0.2; 2], &[0.0, -1.0], method, 0.5);
        assert_eq!((run.stops.len(), run.motion.last().theta), (2, &[-0.2; 2][..]));
        check_limits_and_energy(&model, &run, 10.0 * bound);
        // moving away
        let run = self::run(&model, &[-0.2; 2], &[1.0, 1.0], method, 0.1);
        assert!(run.stops.is_empty() && (run.motion.last().theta[0] - (-0.1 - 0.04905)).abs() < bound);
    }
    // a hair beyond the stop, as a run may leave a joint; more is refused
    let run = run(&model, &[-0.2 - 5e-6; 2], &[0.0, -1.0], Method::Automatic, 0.5);
    let last = run.motion.last();
    assert!(
        last.theta.iter().all(|q| (q + 0.2).abs() <= 5e-6) && last.dtheta.iter().all(|v| v.abs() < 1e-9),
        "{last:?}"
    );
    let options = Options { joint_limits: Policy::Respect, ..Options::new(1.0, 100) };
    assert!(simulate(&model, &[-0.2 - 2e-5; 2], &[0.0; 2], Zero, &options).is_err());
    // a joint that may not move rests against either stop
    let model = slides([0.1, 0.1]);
    let options = Options { joint_limits: Policy::Respect, ..Options::new(1.0, 100) };
    let push = torque(|t, _, _, tau| tau.fill(40.0 * (0.5 - t)));
    let run = Simulation::new(options).run(&model, &[0.1; 2], &[0.0; 2], push).expect("a motion");
    assert!(run.motion.theta.iter().all(|&q| q == 0.1), "{:?}", run.motion.last());
}

#[test]
fn starts_and_limits_without_a_meaning_are_refused_by_name() {
    let refused = |limit: f64| {
        let model = top(inertia(2), limit);
        let options = Options { joint_limits: Policy::Respect, ..Options::new(1.0, 100) };
        let start = [0.6_f64.cos(), 0.0, 0.6_f64.sin(), 0.0];
        simulate(&model, &start, &[0.0; 3], Zero, &options).expect_err("refused").to_string()
    };
    assert!(refused(0.8).contains("of joint `ball of top`, beyond its limits 0 … 0.8"), "{}", refused(0.8));
    assert!(refused(0.0).contains("`ball of top`, a ball that may not turn at all"), "{}", refused(0.0));
}
