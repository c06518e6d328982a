//! Joints with dry friction.

use super::robots::{block, by, pendulum, run};
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, Solid, SpatialInertia, Sym3, Vec3, testing};
use mozzi_sim::{ContactPoint, Contacts, Method, Options, Plane, Simulation, Zero};

#[test]
fn a_held_pendulum_does_not_move() {
    // gravity's moment at 0.5 rad is 4.70 N m
    {
        let method = Method::MoreauJean;
        for step in [1e-2, 4e-3, 1e-3] {
            let run = run(&pendulum(6.0), &[0.5], &[0.0], by(method, 10.0, step));
            let moved = run.motion.theta.iter().map(|x| (x - 0.5).abs()).fold(0.0, f64::max);
            let speed = run.motion.dtheta.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let account = run.one_sided.expect("dry friction");
            println!(
                "{:20} {step:e} s: moved {moved:.1e} rad, speed {speed:.1e} rad/s, residual {:.1e}",
                method.name(),
                account.largest_residual
            );
            assert!(moved <= 1e-12 && account.largest_residual < 1e-10);
        }
    }
}

#[test]
fn the_automatic_method_follows_the_robot() {
    let options = Options::new(0.01, 10);
    assert_eq!(run(&pendulum(0.0), &[0.5], &[0.0], options).method, Method::RungeKutta4);
    assert_eq!(run(&pendulum(0.1), &[0.5], &[0.0], options).method, Method::MoreauJean);
}

#[test]
fn a_block_slides_to_rest() {
    let (speed, model) = (1.50123, block(2.0, 0.0, 5.0, None));
    let expected = speed * speed / 5.0;
    for (method, step, bound) in [(Method::MoreauJean, 1e-2, 1e-12), (Method::MoreauJean, 1e-3, 1e-12)] {
        let run = run(&model, &[0.0], &[speed], by(method, 1.0, step));
        let last = run.motion.last();
        let lost = last.energy.friction_loss - speed * speed;
        println!(
            "{:20} {step:e} s: {:.9} m, error {:.1e} m, speed {:.1e}, loss error {lost:.1e} J",
            method.name(),
            last.theta[0],
            last.theta[0] - expected,
            last.dtheta[0]
        );
        assert!((last.theta[0] - expected).abs() < bound && last.dtheta[0].abs() < 1e-12);
    }
}

#[test]
fn a_spring_with_dry_friction_loses_the_same_each_half_cycle() {
    // peaks fall by 2μ/k = 0.04 m a half cycle of π/10 s, until |kx| ≤ μ at 25 half cycles
    let (k, mu) = (100.0, 2.0);
    for (method, step, bound) in [(Method::MoreauJean, 4e-3, 1e-12), (Method::MoreauJean, 1e-3, 1e-12)] {
        let run = run(&block(1.0, k, mu, None), &[1.0], &[0.0], by(method, 12.0, step));
        // after each turn (x − c)² + ẋ²/ω² = (A − c)² with c = μ/k against the velocity
        let (mut worst, mut turns) = (0.0_f64, 0);
        for i in 1..run.motion.len() {
            let (before, row) = (run.motion.sample(i - 1), run.motion.sample(i));
            let (x, v) = (row.theta[0], row.dtheta[0]);
            if before.dtheta[0] * v < 0.0 || (turns == 0 && v != 0.0) {
                let c = -mu / k * v.signum();
                let peak = ((x - c).powi(2) + v * v / k).sqrt() + mu / k;
                worst = worst.max((peak - (1.0 - 0.04 * f64::from(turns))).abs());
                turns += 1;
            }
            if turns == 25 {
                break;
            }
        }
        let rest = run.motion.last();
        println!(
            "{:20} {step:e} s: {turns} peaks, error {worst:.1e} m, drift {:.1e} J, rest at {:.1e} m, speed {:.1e}",
            method.name(),
            run.motion.largest_drift(),
            rest.theta[0],
            rest.dtheta[0]
        );
        assert!(turns >= 24 && worst < bound && rest.dtheta[0].abs() < 1e-12 && (k * rest.theta[0]).abs() <= mu);
    }
}

#[test]
fn friction_in_every_joint_stays_at_rest_in_free_fall() {
    for seed in 0..20 {
        let model = testing::floating_tree(seed, 12, 2);
        let mut description = model.description().clone();
        for joint in &mut description.joints {
            (joint.damping, joint.friction, joint.stiffness) = (0.0, 0.3, 0.0);
        }
        let model = description.build().expect("sound");
        let [theta, mut dtheta, _] = testing::state(&model, seed);
        dtheta.fill(0.0);
        let run = run(&model, &theta, &dtheta, by(Method::Automatic, 0.5, 1e-3));
        let moved = run
            .motion
            .samples()
            .map(|row| (7..model.nq()).map(|i| (row.theta[i] - theta[i]).abs()).fold(0.0, f64::max));
        let moved = moved.fold(0.0, f64::max);
        println!("seed {seed}: moved {moved:.1e}, residual {:.1e}", run.one_sided.expect("dry").largest_residual);
        assert!(moved < 1e-12);
    }
}

/// A box on the ground with a slide on top that comes to rest within a step, which is divided there: the contacts'
/// force is the mean over the whole step.
#[test]
fn contact_forces_of_a_divided_step_are_its_mean() {
    let up = JointKind::Screw(ScrewAxis::new([0.0; 3], [0.0, 0.0, 1.0]).expect("unit"));
    let slider = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(0.01, 0.01, 0.01));
    let model = Description::new("box with a slide")
        .link("box", Solid::Box([0.2, 0.2, 0.1]).inertia(2.0))
        .link("slider", slider)
        .joint(Joint { friction: 15.0, ..Joint::new("slide", "box", "slider", SE3::identity(), up) })
        .floating()
        .build()
        .expect("sound");
    let base = model.frame("box").expect("there");
    let corners = [[0.1, 0.1], [0.1, -0.1], [-0.1, 0.1], [-0.1, -0.1]];
    let points = corners.map(|[x, y]| ContactPoint::new(format!("{x} {y}"), base, Vec3([x, y, -0.05]), 0.3));
    let contacts = Contacts { points: points.into(), planes: vec![Plane::ground()] };
    let (h, mut dtheta) = (0.01, [0.0; 7]);
    dtheta[6] = 1.2345;
    let theta = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0];
    let simulation = Simulation { contacts, ..Simulation::new(by(Method::Automatic, 0.4, h)) };
    let run = simulation.run(&model, &theta, &dtheta, Zero).expect("a motion");
    let rate = |k: usize| run.motion.sample(k).dtheta[6]; // of the slider's momentum: the box rests
    for k in 1..40 {
        let found: f64 = run.motion.sample(k).contact_forces.iter().map(|force| force.f.0[2]).sum();
        let expected = -3.0 * 9.81 - (rate(k) - rate(k - 1)) / h;
        assert!((found - expected).abs() < 1e-6, "{k}: {found}, expected {expected}");
    }
    assert!(rate(0) > 1.0 && rate(39).abs() < 1e-9, "it comes to rest");
}
