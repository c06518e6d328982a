//! Flat cylinders that fall and slide, edges that joints press on the ground, and long steps.

use super::robots::by;
use mozzi::model::Support;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, Model, SE3, SO3, ScrewAxis, Solid, SpatialInertia, Sym3, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Method, Plane, PlaneMotion, Run, Simulation, Zero};
use std::f64::consts::FRAC_PI_2;

const RADIUS: f64 = 0.1;
const LENGTH: f64 = 0.04;
const G: f64 = 9.81;

/// A disc of 1 kg that floats, with four points on each rim.
fn disc(mu: f64) -> (Model, Contacts<'static>) {
    let inertia = Solid::Cylinder { radius: RADIUS, length: LENGTH }.inertia(1.0);
    let model = Description::new("disc").link("disc", inertia).floating().build().expect("sound");
    let frame = model.frame("disc").expect("there");
    let point = |side: f64, k: usize| {
        let support = Support::Disc { axis: Vec3([0.0, 0.0, 1.0]), radius: RADIUS, turn: k as f64 * FRAC_PI_2 };
        let center = Vec3([0.0, 0.0, 0.5 * side * LENGTH]);
        ContactPoint { support, ..ContactPoint::new(format!("{side} {k}"), frame, center, mu) }
    };
    let points = [-1.0, 1.0].into_iter().flat_map(|side| (0..4).map(move |k| point(side, k))).collect();
    (model, Contacts { points, planes: vec![Plane::ground()] })
}

fn run((model, contacts): (Model, Contacts), start: SE3, dtheta: [f64; 6], [duration, step]: [f64; 2]) -> Run {
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, duration, step)) };
    simulation.run(&model, &start.to_pose(), &dtheta, Zero).expect("a motion")
}

/// The largest rise of kinetic and potential energy in a step, J.
fn largest_rise(run: &Run) -> f64 {
    let energies = run.motion.samples().map(|row| row.energy.kinetic + row.energy.potential).collect::<Vec<_>>();
    energies.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

#[test]
fn a_disc_that_falls_comes_to_rest_on_its_face() {
    for tilt in [0.0_f64, 3.0, 10.0, 30.0] {
        for step in [2e-3, 1e-3, 5e-4] {
            let start = SE3::new(SO3::exp(Vec3([tilt.to_radians(), 0.0, 0.0])), Vec3([0.0, 0.0, 0.3]));
            let run = run(disc(0.7), start, [0.0; 6], [3.0, step]);
            let last = run.motion.last();
            let speed = last.dtheta.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let rise = largest_rise(&run);
            println!("{tilt}°, {step} s: rise {rise:.1e} J, z {:.9}, speed {speed:.1e}", last.theta[6]);
            assert!(rise < 1e-4, "{rise}");
            assert!((last.theta[6] - 0.5 * LENGTH).abs() < 1e-9 && speed < 1e-9, "{} {speed}", last.theta[6]);
            let force = last.total_contact_force();
            assert!((force - Vec3([0.0, 0.0, -G])).norm() < 1e-6 * G, "{force:?}");
        }
    }
}

#[test]
fn a_puck_slides_as_far_as_its_friction_allows() {
    for (mu, v, step) in [(0.2, 0.7, 5e-4), (0.5, 0.7, 1e-3), (0.2, 1.5, 1e-3), (0.3, 1.0, 2e-3)] {
        let start = SE3::translation([0.0, 0.0, 0.5 * LENGTH]);
        let run = run(disc(mu), start, [0.0, 0.0, 0.0, v, 0.0, 0.0], [2.0, step]);
        let (way, expected, rise) = (run.motion.last().theta[4], v * v / (2.0 * mu * G), largest_rise(&run));
        println!("μ {mu}, {v} m/s, {step} s: {way:.6} m of {expected:.6}, rise {rise:.1e} J");
        assert!((way - expected).abs() < 2.0 * step * v && rise < 1e-9, "{way} {expected} {rise}");
    }
}

/// A board on a hinge falls on its edge: the point can stick, or have no gap, and has no gap.
#[test]
fn an_edge_that_sticks_has_no_gap() {
    let inertia = Solid::Box([2.0, 0.2, 0.04]).inertia(4.0);
    let load = SpatialInertia::new(1.0, Vec3([0.8, 0.0, 0.0]), Sym3::diagonal(1e-3, 1e-3, 1e-3));
    let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("unit"));
    let hinge = Joint::new("hinge", "base", "board", SE3::translation([0.0, 0.0, 0.4]), axis);
    let model = Description::new("board").link("base", SpatialInertia::zero()).link("board", inertia + load);
    let model = model.joint(hinge).build().expect("sound");
    let frame = model.frame("board").expect("there");
    for (mu, rate, step) in [(0.7, 0.0, 1e-3), (0.7, 5.0, 1e-3), (0.5, 10.0, 5e-4), (0.7, 20.0, 5e-4), (0.1, 5.0, 1e-3)]
    {
        let corner = |y: f64, z: f64| ContactPoint::new(format!("{y} {z}"), frame, Vec3([1.0, y, z]), mu);
        let points = vec![corner(-0.1, -0.02), corner(0.1, -0.02), corner(-0.1, 0.02), corner(0.1, 0.02)];
        let contacts = Contacts { points, planes: vec![Plane::ground()] };
        let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, 2.0, step)) };
        let run = simulation.run(&model, &[0.0], &[rate], Zero).expect("a motion");
        let gaps = simulation.contacts.gaps(&model, 2.0, run.motion.last().theta);
        let gap = gaps.into_iter().fold(f64::INFINITY, f64::min);
        println!("μ {mu}, {rate} rad/s, {step} s: gap {gap:.1e} m");
        assert!(gap.abs() < 1e-9 && run.motion.last().dtheta[0].abs() < 1e-9, "{gap}");
    }
}

/// The upper corners are within what a long step falls, and are no feet.
#[test]
fn a_box_stays_on_its_feet_in_long_steps() {
    for (half, step) in [(0.1, 0.15), (0.1, 0.5), (4e-4, 0.01)] {
        let model = Description::new("box").link("box", Solid::Box([0.2, 0.2, 2.0 * half]).inertia(1.0));
        let model = model.floating().build().expect("sound");
        let frame = model.frame("box").expect("there");
        let corner = |k: usize| {
            let [x, y, z] = [(0, 0.1), (1, 0.1), (2, half)].map(|(bit, x)| if k >> bit & 1 == 0 { x } else { -x });
            ContactPoint::new(format!("{k}"), frame, Vec3([x, y, z]), 0.7)
        };
        let contacts = Contacts { points: (0..8).map(corner).collect(), planes: vec![Plane::ground()] };
        let run = run((model, contacts), SE3::translation([0.0, 0.0, half]), [0.0; 6], [10.0 * step, step]);
        assert!((run.motion.last().theta[6] - half).abs() < 1e-12, "{step}: {}", run.motion.last().theta[6]);
    }
}

#[test]
fn a_belt_moves_along_its_plane() {
    let (model, mut contacts) = disc(0.5);
    contacts.planes =
        vec![Plane { name: "lift".into(), motion: PlaneMotion::Belt(SE3::identity(), Vec3([0.1, 0.0, 0.5])) }];
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::MoreauJean, 0.1, 1e-3)) };
    let theta = SE3::translation([0.0, 0.0, 0.5 * LENGTH]).to_pose();
    let error = simulation.run(&model, &theta, &[0.0; 6], Zero).map(|_| ()).expect_err("refused").to_string();
    assert!(error.contains("the velocity of a belt") && error.contains("plane `lift`"), "{error}");
}
