//! Adaptive steps that end at touch-downs, lift-offs, and where something begins or ceases to slide.

use super::balls::{RADIUS, ball, bounced, rolling};
use super::boxes::on_slope;
use super::robots::{block, by, pendulum, run};
use mozzi::simulation::{Method, Options, Plane, Policy, Simulation, torque};

const DOPRI: Method = Method::DormandPrince { tolerance: 1e-12 };

#[test]
fn a_held_pendulum_does_not_move_between_events() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let run = run(&pendulum(6.0), &[0.5], &[0.0], by(Method::DormandPrince { tolerance }, 10.0, 0.1));
        let moved = run.motion.theta.iter().map(|x| (x - 0.5).abs()).fold(0.0, f64::max);
        println!("tolerance {tolerance:e}: moved {moved:.1e} rad in {} steps", run.motion.steps);
        assert!(moved <= 1e-12);
    }
}

#[test]
fn a_block_slides_to_rest_between_events() {
    let (speed, model) = (1.50123, block(2.0, 0.0, 5.0, None));
    let run = run(&model, &[0.0], &[speed], by(DOPRI, 1.0, 0.01));
    let (last, expected) = (run.motion.last(), speed * speed / 5.0);
    println!(
        "{:.9} m, error {:.1e} m, loss error {:.1e} J",
        last.theta[0],
        last.theta[0] - expected,
        last.energy.friction_loss - speed * speed
    );
    assert!((last.theta[0] - expected).abs() < 1e-12 && last.dtheta[0] == 0.0);
}

#[test]
fn a_spring_loses_the_same_each_half_cycle_between_events() {
    let (k, mu) = (100.0, 2.3);
    let run = run(&block(1.0, k, mu, None), &[1.0], &[0.0], by(DOPRI, 12.0, 0.01));
    // 1 − 0.046 a half cycle: 0.034 after 21 of them, which μ/k = 0.023 does not hold, then −(0.046 − 0.034)
    let expected = 0.012_f64;
    let last = run.motion.last();
    println!(
        "rest at {:.6} m, expected {expected:.6}, drift {:.1e}, {} steps",
        last.theta[0],
        run.motion.largest_drift(),
        run.motion.steps
    );
    assert!((last.theta[0].abs() - expected).abs() < 1e-9);
    assert!(last.dtheta[0] == 0.0 && run.motion.largest_drift() < 1e-9);
}

#[test]
fn a_ball_bounces_between_events() {
    let start = [[0.0, 0.0, 1.0 + RADIUS], [0.0; 3], [0.0; 3]];
    let run = rolling(&ball(), Plane::ground(), 0.5, 0.8, start, by(DOPRI, 6.0, 0.01));
    let mut worst = 0.0_f64;
    for row in run.motion.samples() {
        worst = worst.max((row.theta[6] - RADIUS - bounced(row.t, 0.8)).abs());
    }
    let last = run.motion.last();
    println!(
        "largest error {worst:.1e} m, at the end gap {:.1e} m, speed {:.1e}, {} steps",
        last.theta[6] - RADIUS,
        last.dtheta[5],
        run.motion.steps
    );
    assert!(worst < 1e-9 && last.dtheta[5].abs() < 1e-12);
}

#[test]
fn a_ball_begins_to_roll_between_events() {
    let (v, mu, g) = (1.4, 0.2, 9.81);
    let start = [[0.0, 0.0, RADIUS], [0.0; 3], [v, 0.0, 0.0]];
    let rolls = 2.0 * v / (7.0 * mu * g);
    let run =
        rolling(&ball(), Plane::ground(), mu, 0.0, start, by(Method::DormandPrince { tolerance: 1e-10 }, 1.0, 0.01));
    let way = v * rolls - 0.5 * mu * g * rolls * rolls + 5.0 / 7.0 * v * (1.0 - rolls);
    let last = run.motion.last();
    println!("way error {:.1e} m in {} steps", last.theta[4] - way, run.motion.steps);
    assert!((last.theta[4] - way).abs() < 1e-7);
}

#[test]
fn boxes_stick_and_slide_between_events() {
    for points in [4, 8] {
        let (run, way, gap) = on_slope(points, 20_f64.to_radians(), [0.0, 0.0], DOPRI, [1.0, 0.01]);
        println!(
            "{points} points stick: moved {:.1e} m, gap {gap:.1e} m, {} steps",
            way[0].hypot(way[1]),
            run.motion.steps
        );
        assert!(way[0].hypot(way[1]) < 1e-12 && gap < 1e-12);
        let angle = 35_f64.to_radians();
        let a = 9.81 * (angle.sin() - 0.5 * angle.cos());
        let (run, way, gap) = on_slope(points, angle, [0.0, 0.0], DOPRI, [1.0, 0.01]);
        println!(
            "{points} points slide: error {:.1e} m, gap {gap:.1e} m, {} steps",
            (way[0] - 0.5 * a).hypot(way[1]),
            run.motion.steps
        );
        assert!((way[0] - 0.5 * a).hypot(way[1]) < 1e-9 && gap < 1e-12);
    }
}

#[test]
fn a_stop_with_friction_holds_and_releases_between_events() {
    let model = block(2.0, 0.0, 1.0, Some([-1.0, 0.3]));
    let motor = torque(|t, _, _, tau| tau[0] += if t < 1.0 { 5.0 } else { -3.0 });
    let options = Options { joint_limits: Policy::Respect, ..by(Method::DormandPrince { tolerance: 1e-9 }, 1.5, 1e-2) };
    let run = Simulation::new(options).run(&model, &[0.0], &[0.0], motor).expect("a motion");
    let last = run.motion.last();
    println!("end error {:.1e} m, {:?}, {} steps", last.theta[0] - 0.175, run.stops, run.motion.steps);
    assert!((last.theta[0] - 0.175).abs() < 1e-6 && (run.stops[0].first - 0.3_f64.sqrt()).abs() < 1e-9);
}
