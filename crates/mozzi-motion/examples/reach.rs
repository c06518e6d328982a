//! Inverse kinematics at 10,000 reachable poses of each embedded robot: how many are reached, by how many starts, and
//! how fast.
//!
//! `cargo run --release -p mozzi-motion --example reach [POSES]`

use mozzi::Model;
use mozzi::kinematics::forward_kinematics;
use mozzi::random::Random;
use mozzi_motion::inverse_kinematics::{Method, Options};
use mozzi_motion::{Goal, InverseKinematics};
use std::f64::consts::PI;
use std::time::Instant;

const ROBOTS: [(&str, &str); 6] = [
    ("ur5", "tool0"),
    ("panda", "panda_hand"),
    ("anymal", "LF_FOOT"),
    ("double_pendulum", "tip"),
    ("furuta_pendulum", "tip"),
    ("two_link_planar", "tip"),
];

/// Within the limits; half a turn either way for a joint without limits.
fn random(model: &Model, random: &mut Random) -> Vec<f64> {
    let anywhere = |joint: &mozzi::model::description::Joint| {
        let [low, high] = joint.limits.position.unwrap_or([-PI, PI]);
        0.5 * (low + high) + 0.5 * (high - low) * random.next()
    };
    model.joints().map(anywhere).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let poses: usize = std::env::args().nth(1).map_or(Ok(10_000), |text| text.parse())?;
    println!(
        "{:16} {:20} {:>8} {:>12} {:>8} {:>12} {:>10}",
        "robot", "method", "reached", "at 1st start", "starts", "iterations", "µs"
    );
    for (name, frame) in ROBOTS {
        let model = mozzi_urdf::open(name)?.build()?;
        let frame = model.frame(frame)?;
        for method in [Method::LevenbergMarquardt, Method::Newton] {
            let mut numbers = Random(1);
            let options = Options { method, ..Options::default() };
            let mut solver = InverseKinematics::with_options(&model, frame, options)?;
            let (mut reached, mut first, mut starts, mut iterations, mut seconds) = (0, 0, 0, 0, 0.0);
            for _ in 0..poses {
                let (theta, guess) = (random(&model, &mut numbers), random(&model, &mut numbers));
                let goal = Goal::Pose(forward_kinematics(&model, &theta, frame));
                let begin = Instant::now();
                let answer = solver.solve(goal, &guess);
                seconds += begin.elapsed().as_secs_f64();
                if let Ok(found) = answer {
                    (reached, starts, iterations) = (reached + 1, starts + found.starts, iterations + found.iterations);
                    first += usize::from(found.starts == 1);
                }
            }
            let mean = |sum: usize| sum as f64 / reached as f64;
            println!(
                "{name:16} {:20} {reached:8} {first:12} {:8.2} {:12.1} {:10.1}",
                format!("{method:?}"),
                mean(starts),
                mean(iterations),
                1e6 * seconds / poses as f64
            );
        }
    }
    Ok(())
}
