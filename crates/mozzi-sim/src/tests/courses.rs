//! Events in every method, contacts by their pairs, and motions that end with an error.

use super::robots::pendulum;
use crate::{
    ContactChange, ContactPoint, Contacts, Direction, Error, Event, GravityCompensation, Input, Method, Options, Plane,
    Policy, Simulation, Zero, simulate,
};
use alloc::format;
use alloc::string::ToString;
use alloc::vec;
use mozzi::model::description::{Joint, JointKind};
use mozzi::testing::four_bar;
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3};

const METHODS: [Method; 6] = [
    Method::Euler,
    Method::SemiImplicitEuler,
    Method::RungeKutta4,
    Method::Midpoint,
    Method::DormandPrince { tolerance: 1e-9 },
    Method::MoreauJean,
];

/// A block that slides along x, which gravity does not move.
fn block(limits: Option<[f64; 2]>, mass: f64) -> Model {
    let along = JointKind::Screw(ScrewAxis::new([0.0; 3], [1.0, 0.0, 0.0]).expect("unit"));
    let mut joint = Joint::new("slide", "base", "block", SE3::identity(), along);
    joint.limits.position = limits;
    let body = SpatialInertia::new(mass, Vec3::zero(), Sym3::diagonal(mass, mass, mass));
    let robot = Description::new("block").link("base", SpatialInertia::zero()).link("block", body).joint(joint);
    robot.build().expect("sound")
}

#[test]
fn events_are_located_by_every_method() {
    let model = block(None, 1.0);
    for method in METHODS {
        let run = |direction, stop| {
            let event = Event::new("there", |_, theta: &[f64], _: &[f64]| theta[0] - 0.35);
            let events = vec![Event { direction, stop, ..event }];
            let options = Options { method, ..Options::new(1.0, 7) };
            let simulation = Simulation { events, ..Simulation::new(options) };
            simulation.run(&model, &[0.0], &[1.0], Zero).expect("a motion")
        };
        let found = run(Direction::Any, false);
        let [event] = &found.events[..] else { panic!("{}: {:?}", method.name(), found.events) };
        assert!((event.t - 0.35).abs() < 1e-9 && (event.theta[0] - 0.35).abs() < 1e-9, "{}: {event:?}", method.name());
        assert!(found.motion.complete && !event.stop && (found.motion.last().theta[0] - 1.0).abs() < 1e-9);
        assert!(run(Direction::Falling, true).events.is_empty());
        let found = run(Direction::Rising, true);
        assert!(!found.motion.complete && (found.motion.last().t - 0.35).abs() < 1e-9, "{}", method.name());
        assert!((found.motion.last().theta[0] - 0.35).abs() < 1e-9 && found.events[0].stop);
    }
}

#[test]
fn limits_are_events_by_their_word() {
    let model = block(Some([-0.2, 0.4]), 1.0);
    let events = Event::condition(&model, "joint-limit").expect("limits");
    let options = Options { joint_limits: Policy::Ignore, ..Options::new(1.0, 10) };
    let run = Simulation { events, ..Simulation::new(options) }.run(&model, &[0.0], &[1.0], Zero).expect("a motion");
    assert_eq!(run.events[0].name, "joint-limit: upper limit of slide");
    assert!((run.events[0].t - 0.4).abs() < 1e-9);
    let endless = block(None, 1.0);
    let wrong = |model: &Model, text: &str| Event::condition(model, text).map(|_| ()).expect_err("wrong").to_string();
    assert!(wrong(&endless, "joint-limit").contains("no joint of `block` has a limit of position"));
    assert!(wrong(&endless, "slide").contains("is no condition, expected a joint"));
}

/// Within a step of Moreau and Jean works grow with time, so that a motion that ends there keeps its balance.
#[test]
fn a_condition_within_a_step_has_its_works() {
    let model = pendulum(0.5, 0.3);
    let push = || crate::torque(|_, _, _, tau| tau[0] += 2.0);
    let options = Options { method: Method::MoreauJean, ..Options::new(1.0, 200) };
    let whole = simulate(&model, &[1.0], &[0.0], push(), &options).expect("a motion").largest_drift();
    for target in [0.8, 0.5, 0.3, 0.1, -0.2] {
        let event = Event::new("there", move |_, theta: &[f64], _: &[f64]| theta[0] - target);
        let events = vec![Event { stop: true, ..event }];
        let run = Simulation { events, ..Simulation::new(options) }.run(&model, &[1.0], &[0.0], push());
        let motion = run.expect("a motion").motion;
        let drift = motion.largest_drift();
        assert!((motion.last().theta[0] - target).abs() < 1e-9 && drift < 4.0 * whole, "{target}: {drift:e} {whole:e}");
    }
}

/// A limit that a long step passes and comes back from.
#[test]
fn adaptive_steps_report_limits_between_their_ends() {
    let mut robot = pendulum(0.0, 0.0).description().clone();
    robot.joints[0].limits.position = Some([-0.31, 0.31]);
    let model = robot.build().expect("sound");
    let reported = |method| {
        let options = Options { method, joint_limits: Policy::Report, ..Options::new(3.0, 3000) };
        let run = Simulation::new(options).run(&model, &[-0.309], &[0.1], Zero).expect("a motion");
        run.stops.iter().map(|stop| (stop.limit, (stop.first * 1e3).round(), stop.times)).collect::<Vec<_>>()
    };
    let expected = reported(Method::RungeKutta4);
    assert!(expected.len() == 2 && expected[0].2 == 2, "{expected:?}");
    assert_eq!(reported(Method::DormandPrince { tolerance: 1e-8 }), expected);
}

#[test]
fn motors_of_a_loop_hold_it_and_inputs_know_their_robot() {
    let mut description = four_bar().description().clone();
    description.motors = Some(vec!["crank_pivot".to_string()]);
    let model = description.build().expect("sound");
    let theta = model.assemble(&[1.0, -0.6, 1.6], &["crank_pivot"]).expect("closes");
    let options = Options::new(0.5, 500);
    let motion = simulate(&model, &theta, &[0.0; 3], GravityCompensation::new(&model), &options).expect("a motion");
    let moved = motion.last().theta.iter().zip(&theta).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-9 && motion.last().tau[0].abs() > 1e-3, "{moved} {:?}", motion.last().tau);
    let error = GravityCompensation::new(&model).torque(0.0, &[0.0], &[0.0], &mut [0.0]).expect_err("another robot");
    assert_eq!(error.to_string(), "theta has 1 entries, expected 3");
}

#[test]
fn what_cannot_go_on_ends_with_its_reason() {
    // a loop that turns a full round in a step
    let model = four_bar();
    let theta = model.assemble(&[1.0, -0.6, 1.6], &["crank_pivot"]).expect("closes");
    let dtheta = model.assemble_velocities(&theta, &[300.0, 0.0, 0.0], &["crank_pivot"]).expect("moves");
    for method in [Method::MoreauJean, Method::Midpoint] {
        let options = Options { method, ..Options::new(20.0, 10) };
        let error = simulate(&model, &theta, &dtheta, Zero, &options).expect_err("too long").to_string();
        assert!(
            error.contains("step is too long") || error.contains("did not converge in"),
            "{}: {error}",
            method.name()
        );
    }
    // a link that nothing holds back
    let options = Options { method: Method::MoreauJean, ..Options::new(0.1, 10) };
    let contacts = Contacts {
        points: vec![ContactPoint::new("tip", block(None, 0.0).frame("block").expect("there"), Vec3::zero(), 0.5)],
        planes: vec![Plane::ground()],
    };
    let simulation = Simulation { contacts, ..Simulation::new(options) };
    let error = simulation.run(&block(None, 0.0), &[0.0], &[0.0], Zero).expect_err("no mass").to_string();
    assert!(error.contains("the mass matrix is singular at joint `slide`"), "{error}");
    // a start in the ground
    let model = pendulum(0.0, 0.0);
    let contacts = Contacts {
        points: vec![ContactPoint::new("bob", model.frame("bob").expect("there"), Vec3([0.0, 0.0, -0.7]), 0.5)],
        planes: vec![Plane::ground(), Plane::fixed("shelf", SE3::translation([0.0, 0.0, -1.0]))],
    };
    assert_eq!((contacts.pairs(), contacts.point(1).name.as_str()), (2, "bob"));
    assert_eq!(contacts.plane(1).name, "shelf");
    let frame = contacts.frame(&model, 0.0, &[0.0], 1);
    assert!((frame.p - Vec3([0.0, 0.0, -0.7])).norm() < 1e-15);
    let simulation = Simulation { contacts, ..Simulation::new(Options::new(0.1, 10)) };
    let error = simulation.run(&model, &[0.0], &[0.0], Zero).expect_err("inside").to_string();
    assert!(error.contains("contact point `bob") && error.contains("0.700000 m within its plane"), "{error}");
    let base =
        Error::Diverged { quantity: "theta", joint: "".into(), value: 1e300, step: 0, time: 0.0, step_size: 1e-3 };
    assert!(format!("{base}").contains("theta of the base is 1e300"), "{base}");
    assert_eq!(ContactChange::ALL.map(ContactChange::name), ["touches down", "lifts off", "sticks", "slides"]);
}
