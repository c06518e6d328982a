//! Random robots dropped on the ground: every simulation ends, and friction never gives energy.

use super::robots::by;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, Model, SE3, ScrewAxis, Solid, SpatialInertia, Sym3, Vec3, testing};
use mozzi_sim::{ContactPoint, Contacts, Method, Options, Plane, Policy, Run, Simulation, Zero};

/// A floating tree with friction, and a contact point at each link's origin.
fn robot(seed: u64) -> (Model, Contacts<'static>) {
    let model = testing::floating_tree(seed, 2 + seed as usize % 6, seed as usize % 2);
    let mut random = testing::Random(seed);
    let points = model.frames().take(8).map(|(frame, name)| {
        let mu = 0.5 + 0.5 * random.next();
        ContactPoint::new(name, frame, Vec3(random.array::<3>().map(|x| 0.1 * x)), mu)
    });
    let points = points.collect();
    (model, Contacts { points, planes: vec![Plane::ground()] })
}

/// The robot, dropped from 5 cm.
fn dropped(seed: u64, duration: f64, step: f64) -> Run {
    let (model, contacts) = robot(seed);
    let [mut theta, dtheta, _] = testing::state(&model, seed);
    let lowest = contacts.gaps(&model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
    theta[6] += 0.05 - lowest;
    let options = Options { joint_limits: Policy::Ignore, ..by(Method::Automatic, duration, step) };
    let run = Simulation { contacts, ..Simulation::new(options) }.run(&model, &theta, &dtheta, Zero);
    run.unwrap_or_else(|error| panic!("{seed}: {error}"))
}

/// The largest rise of the energy above its least so far, as a part of the largest kinetic energy.
fn gain(run: &Run) -> f64 {
    let (mut worst, mut least) = (0.0_f64, f64::INFINITY);
    for energy in &run.motion.energy {
        let now = energy.kinetic + energy.potential;
        worst = worst.max((now - least) / run.motion.largest_kinetic_energy());
        least = least.min(now);
    }
    worst
}

#[test]
fn a_thousand_drops_end_and_lose_energy() {
    let (mut worst, mut largest, mut unsolved, mut steps) = (0.0_f64, 0.0_f64, 0, 0);
    let (mut drift, mut lifted, mut halvings, mut unsettled) = (0.0_f64, 0.0_f64, 0, 0);
    let count = 1000;
    for seed in 0..count {
        let run = dropped(seed, 0.3, 2e-3);
        assert!(run.motion.complete);
        let account = run.one_sided.expect("contacts");
        largest = largest.max(account.largest_residual);
        unsolved += account.unsolved;
        steps += account.steps;
        let size = run.motion.largest_kinetic_energy();
        worst = worst.max(gain(&run));
        drift = drift.max(run.motion.largest_drift() / size);
        lifted = lifted.max(account.lifted / size);
        halvings += account.halvings;
        unsettled += account.unsettled;
    }
    println!(
        "{count} drops, {steps} steps: largest residual {largest:.1e} m/s, {unsolved} steps above 1e-6, largest gain \
         {worst:.1e} of the kinetic energy, drift {drift:.1e}, lifted {lifted:.1e}, {halvings} halvings, {unsettled} unsettled"
    );
    assert!(worst < 1e-4 && drift < 2e-2 && unsolved == 0);
}

#[test]
fn steps_that_would_lift_much_are_halved() {
    let (mut worst, mut halvings) = (0.0_f64, 0);
    for seed in 0..60 {
        let run = dropped(seed, 1.0, 1e-2);
        halvings += run.one_sided.expect("contacts").halvings;
        worst = worst.max(gain(&run));
    }
    println!("largest gain {worst:.1e} of the kinetic energy, {halvings} halvings");
    assert!(worst < 1e-3);
}

#[test]
fn positions_are_not_put_right_by_throwing_light_links() {
    // a box on four corners, and a knob whose point is 10 µm beside its hinge and 10 µm too deep: a turn would lift it
    let knob = SpatialInertia { mass: 0.01, mc: Vec3::zero(), I: Sym3::diagonal(1e-6, 1e-6, 1e-6) };
    let turn = JointKind::Screw(ScrewAxis::new([1.0, 0.0, 0.0], [0.0; 3]).expect("unit"));
    let model = Description::new("box with a knob")
        .link("box", Solid::Box([0.1; 3]).inertia(1.0))
        .link("knob", knob)
        .joint(Joint::new("hinge", "box", "knob", SE3::translation([0.0, 0.0, -0.05]), turn))
        .floating()
        .build()
        .expect("sound");
    let point = |name: &str, link: &str, at| ContactPoint::new(name, model.frame(link).expect("there"), Vec3(at), 0.5);
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let mut points = corners.map(|[x, y]| point("corner", "box", [0.05 * x, 0.05 * y, -0.05])).to_vec();
    points.push(point("knob", "knob", [0.0, 1e-5, -1e-5]));
    let contacts = Contacts { points, planes: vec![Plane::ground()] };
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::Automatic, 0.2, 1e-3)) };
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0];
    let run = simulation.run(&model, &start, &[0.0; 7], Zero).expect("a motion");
    let turned = run.motion.samples().map(|row| row.theta[7].abs()).fold(0.0, f64::max);
    let lifted = run.one_sided.expect("contacts").lifted;
    println!("the hinge turns by {turned:.1e} rad, lifted by {lifted:.1e} J");
    assert!(turned < 0.1 && lifted.abs() < 1e-3);
}
