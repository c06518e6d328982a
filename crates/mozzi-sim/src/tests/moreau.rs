//! The Moreau-Jean step of smooth motions: order, works, and bodies that move freely.

use crate::{Error, Input, Method, Options, Zero, simulate};
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, SpatialInertia, Sym3, Vec3, testing};

/// A spring and a damper at every joint; the step knows their gains.
struct Servo;

const STIFFNESS: f64 = 60.0;
const DAMPING: f64 = 5.0;

impl Input for Servo {
    fn torque(&mut self, _: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        let forces = theta.iter().zip(dtheta).map(|(x, v)| -STIFFNESS * x - DAMPING * v);
        tau.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
        Ok(())
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        stiffness.iter_mut().for_each(|sum| *sum += STIFFNESS);
        damping.iter_mut().for_each(|sum| *sum += DAMPING);
    }
}

#[test]
fn springs_dampers_and_servos_are_of_order_two_and_all_work_is_known() {
    let mut robot = testing::tree(3, 5, 0).description().clone();
    for joint in &mut robot.joints {
        (joint.friction, joint.damping, joint.stiffness) = (0.0, 2.0, 9.0);
    }
    let model = robot.build().expect("sound");
    let [theta, dtheta, _] = testing::state(&model, 3);
    let run = |method, steps| {
        let options = Options { method, ..Options::new(0.5, steps) };
        simulate(&model, &theta, &dtheta, Servo, &options).expect("a motion")
    };
    let exact = run(Method::RungeKutta4, 8000);
    let error = |steps| {
        let motion = run(Method::MoreauJean, steps);
        let apart = motion.last().theta.iter().zip(exact.last().theta).map(|(a, b)| (a - b).abs());
        (apart.fold(0.0, f64::max), motion.largest_drift())
    };
    let ((coarse, drift), (fine, less)) = (error(500), error(1000));
    std::println!("errors {coarse:.1e} {fine:.1e}, drifts {drift:.1e} {less:.1e}");
    assert!((3.6..4.4).contains(&(coarse / fine)) && fine < 1e-4, "{coarse:e} {fine:e}");
    assert!((3.0..5.0).contains(&(drift / less)) && less < 1e-3, "{drift:e} {less:e}");
}

/// Origins of free bodies move straight while they spin, whichever place their numbers have in θ.
#[test]
fn two_free_bodies_move_straight() {
    let ball = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(0.1, 0.1, 0.1));
    let free = |name: &str, body: &str| Joint::new(name, "world", body, SE3::identity(), JointKind::Free);
    let robot = Description::new("balls").with_gravity([0.0; 3]).link("world", SpatialInertia::zero());
    let robot = robot.link("a", ball).link("b", ball).joint(free("first", "a")).joint(free("second", "b"));
    let model = robot.build().expect("sound");
    let [theta, dtheta, _] = testing::state(&model, 4);
    let options = Options { method: Method::MoreauJean, ..Options::new(1.0, 10) };
    let motion = simulate(&model, &theta, &dtheta, Zero, &options).expect("a motion");
    for body in ["a", "b"] {
        let frame = model.frame(body).expect("a link");
        let pose = |theta: &[f64]| model.forward_kinematics(theta, frame).expect("lengths");
        let V = &model.body_jacobian(&theta, frame).expect("lengths") * &dtheta[..];
        let start = pose(&theta);
        let expected = start.p + start.R * V.v;
        let apart = (pose(motion.last().theta).p - expected).norm();
        assert!(apart < 1e-12, "{body}: {apart:e}");
    }
}
