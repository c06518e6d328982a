//! Boxes and balls that are tossed: they rest on the ground, each impact is an event, and what is elastic keeps its
//! energy.

use super::balls::{RADIUS, ball, rolling};
use super::robots::by;
use mozzi::{Description, Model, SE3, Solid, Vec3, testing};
use mozzi_sim::{ContactChange, ContactPoint, Contacts, Method, Plane, Run, Simulation, Zero};

/// A free box, its eight corners, and a ground.
fn tossed(size: [f64; 3], [mu, restitution]: [f64; 2], seed: u64, duration: f64, step: f64) -> (Run, f64) {
    let model = Description::new("box").link("box", Solid::Box(size).inertia(1.0)).floating().build().expect("sound");
    let contacts = || corners(&model, size, mu, restitution);
    let mut random = testing::Random(seed);
    let turn = SE3::exp(mozzi::Twist { w: Vec3(random.array()) * 3.0, v: Vec3::zero() });
    let mut theta = turn.to_pose();
    let gap = |theta: &[f64]| contacts().gaps(&model, 0.0, theta).into_iter().fold(f64::INFINITY, f64::min);
    theta[6] = 0.3 - gap(&theta);
    let dtheta = random.array::<6>().map(|x| 3.0 * x);
    let simulation = Simulation { contacts: contacts(), ..Simulation::new(by(Method::Automatic, duration, step)) };
    let run = simulation.run(&model, &theta, &dtheta, Zero).expect("a motion");
    let deepest = gap(run.motion.last().theta);
    (run, deepest)
}

fn corners(model: &Model, size: [f64; 3], mu: f64, restitution: f64) -> Contacts<'static> {
    let frame = model.frame("box").expect("there");
    let corner = |k: usize| {
        let at = std::array::from_fn(|i| if k >> i & 1 == 0 { 0.5 * size[i] } else { -0.5 * size[i] });
        ContactPoint { restitution, ..ContactPoint::new(format!("p{k}"), frame, Vec3(at), mu) }
    };
    Contacts { points: (0..8).map(corner).collect(), planes: vec![Plane::ground()] }
}

#[test]
fn long_boxes_rest_on_the_ground_not_within_it() {
    for (size, step) in [([1.0, 0.04, 0.04], 5e-3), ([0.6, 0.04, 0.02], 5e-3), ([0.5, 0.02, 0.01], 1e-3)] {
        let (mut deepest, mut fastest) = (0.0_f64, 0.0_f64);
        for seed in 0..25 {
            let (run, gap) = tossed(size, [0.7, 0.0], seed, 4.0, step);
            deepest = deepest.min(gap);
            fastest = run.motion.last().dtheta.iter().fold(fastest, |most, rate| most.max(rate.abs()));
        }
        println!("{size:?} m, {step} s: lowest corner {deepest:.1e} m, fastest {fastest:.1e}");
        assert!(deepest > -1e-6 && fastest < 1e-9);
    }
}

#[test]
fn elastic_boxes_without_friction_keep_their_energy() {
    for step in [4e-3, 1e-3, 2.5e-4] {
        let mut worst = 0.0_f64;
        for seed in 0..12 {
            let (run, _) = tossed([0.3, 0.2, 0.1], [0.0, 1.0], seed, 2.0, step);
            let energies = run.motion.energy.iter().map(|energy| energy.kinetic + energy.potential);
            let first = run.motion.energy[0].kinetic + run.motion.energy[0].potential;
            worst = energies.fold(worst, |most, now| most.max((now / first - 1.0).abs()));
        }
        println!("{step} s: energy off by {worst:.1e}");
        assert!(worst < 5.0 * step);
    }
}

#[test]
fn each_impact_is_an_event() {
    for (restitution, step) in [(0.5, 1e-3), (0.9, 1e-3), (0.7, 5e-4), (0.5, 2e-3)] {
        let start = [[0.0, 0.0, 0.5 + RADIUS], [0.0; 3], [0.0; 3]];
        let run = rolling(&ball(), Plane::ground(), 0.5, restitution, start, by(Method::Automatic, 1.0, step));
        let impacts = run.motion.samples().filter(|row| row.total_contact_force().norm() > 50.0).count();
        let touches = run.contact_events.iter().filter(|event| event.change == ContactChange::TouchDown).count();
        println!("e = {restitution}, {step} s: {impacts} impacts, {touches} events");
        assert!(impacts > 1 && touches >= impacts);
    }
}
