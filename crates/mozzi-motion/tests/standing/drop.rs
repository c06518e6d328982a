//! ANYmal drops, stands and squats.

use crate::anymal::{FEET, POSE, Springs, anymal, feet, mass, start};
use mozzi::{Model, Vec3};
use mozzi_sim::{Method, Options, Run, Simulation};

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn places(model: &Model, theta: &[f64]) -> Vec<Vec3> {
    let place = |name: &&str| model.forward_kinematics(theta, model.frame(name).expect("there")).expect("lengths").p;
    FEET.iter().map(place).collect()
}

/// The force on the ground at row k, N.
fn carried(run: &Run, k: usize) -> Vec3 {
    run.motion.sample(k).total_contact_force()
}

#[test]
fn it_drops_and_stands() {
    for (friction, step) in [(0.0, 4e-3), (0.0, 2e-3), (0.0, 1e-3), (0.5, 1e-3)] {
        let model = anymal(friction);
        let contacts = feet(&model, 0.7);
        let theta = start(&model, &contacts, 0.05);
        let options = Options { method: Method::Automatic, ..Options::with_step(10.0, step).expect("fits") };
        let motors = Springs { k: 400.0, d: 10.0, pose: |_| POSE };
        let clock = std::time::Instant::now();
        let run = Simulation { contacts, ..Simulation::new(options) }
            .run(&model, &theta, &vec![0.0; model.n()], motors)
            .expect("a motion");
        let clock = clock.elapsed().as_secs_f64() / run.motion.steps as f64 * 1e6;
        let at = |t: f64| (t / step).round() as usize;
        let speeds: Vec<String> =
            (1..=10).map(|t| format!("{:.0e}", largest(run.motion.sample(at(t as f64)).dtheta))).collect();
        let last = run.motion.last();
        let weight = mass(&model) * 9.81;
        let force = carried(&run, run.motion.len() - 1);
        let moved = places(&model, run.motion.sample(at(6.0)).theta)
            .iter()
            .zip(places(&model, last.theta))
            .map(|(a, b)| (*a - b).norm())
            .fold(0.0, f64::max);
        let account = run.one_sided.expect("contacts");
        println!(
            "friction {friction}, {step:e} s: speeds at 1 … 10 s {speeds:?}, weight off {:.1e}, feet moved {moved:.1e} m from 6 to 10 s,\n  heights {:?}, {account:?}, {clock:.0} µs a step",
            -force.0[2] / weight - 1.0,
            places(&model, last.theta).iter().map(|p| format!("{:.0e}", p.0[2])).collect::<Vec<_>>(),
        );
        let after: f64 = (at(6.0)..run.motion.len()).map(|k| largest(run.motion.sample(k).dtheta)).fold(0.0, f64::max);
        assert!(after < 1e-9, "{after:e}");
        assert!((-force.0[2] / weight - 1.0).abs() < 1e-9 && moved < 1e-9);
        assert!(account.largest_residual <= 1e-6 && account.last_residual <= 1e-10 && account.unsolved == 0);
    }
}

#[test]
fn it_squats_on_feet_that_stay() {
    for step in [4e-3, 1e-3] {
        let model = anymal(0.0);
        let contacts = feet(&model, 1.0);
        let theta = start(&model, &contacts, 0.0);
        let options = Options::with_step(6.0, step).expect("fits");
        let pose = |t: f64| {
            let bend = if t < 1.0 { 0.0 } else { 0.1 * (2.0 * std::f64::consts::PI * (t - 1.0)).sin() };
            POSE.map(|x| if x == 0.0 { 0.0 } else { x + bend * x.signum() })
        };
        let motors = Springs { k: 400.0, d: 10.0, pose };
        let run = Simulation { contacts, ..Simulation::new(options) }
            .run(&model, &theta, &vec![0.0; model.n()], motors)
            .expect("a motion");
        let at = |t: f64| (t / step).round() as usize;
        let first = places(&model, run.motion.sample(at(1.0)).theta);
        let moved = (at(1.0)..run.motion.len())
            .flat_map(|k| places(&model, run.motion.sample(k).theta).into_iter().zip(first.clone()).collect::<Vec<_>>())
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        println!(
            "{step:e} s: feet move at most {moved:.1e} m in 5 s of squats, {:?}",
            run.one_sided.expect("contacts")
        );
        assert!(moved < 1e-6);
    }
}
