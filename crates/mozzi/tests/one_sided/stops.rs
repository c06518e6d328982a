//! Stops as impulses, next to dry friction.

use super::robots::{FIXED, block, by, run};
use mozzi::simulation::{Method, Options, Policy, Simulation, torque};

#[test]
fn a_block_is_pushed_against_its_stop_and_pulled_away() {
    // 2 kg, friction 1 N, pushed by 5 N from 0 to a stop at 0.3 m, from 1 s on pulled by 3 N
    let model = block(2.0, 0.0, 1.0, Some([-1.0, 0.3]));
    let motor = || torque(|t, _, _, tau| tau[0] += if t < 1.0 { 5.0 } else { -3.0 });
    for (method, bound) in FIXED.into_iter().zip([1e-3, 4e-3, 4e-3, 4e-3, 4e-3]) {
        let options = Options { joint_limits: Policy::Respect, ..by(method, 1.5, 1e-3) };
        let run = Simulation::new(options).run(&model, &[0.0], &[0.0], motor()).expect("a motion");
        let at = |t: f64| run.motion.sample((t * 1e3).round() as usize);
        let impact = (2.0 * 0.3 / 2.0_f64).sqrt();
        let last = run.motion.last();
        let expected = 0.3 - 0.5 * 1.0 * 0.25;
        println!(
            "{:20} at rest {:.1e} m beyond, speed {:.1e}, end error {:.1e} m, {:?}",
            method.name(),
            at(0.9).theta[0] - 0.3,
            at(0.9).dtheta[0],
            last.theta[0] - expected,
            run.stops
        );
        assert!((at(0.9).theta[0] - 0.3).abs() < 1e-12 && at(0.9).dtheta[0].abs() < 1e-12);
        assert!((last.theta[0] - expected).abs() < bound);
        let [stop] = &run.stops[..] else { panic!("{:?}", run.stops) };
        assert!((stop.first - impact).abs() < 3e-3 && stop.limit == 0.3 && stop.times == 1);
        // the impact's energy is lost
        let lost = 5.0 * 0.3 + 1.0 * (0.3 - expected);
        assert!((last.energy.friction_loss - lost).abs() < 0.02, "{:?} {lost}", last.energy);
    }
}

#[test]
fn stops_alone_are_still_located() {
    let model = block(2.0, 0.0, 0.0, Some([-1.0, 0.3]));
    let options = Options { joint_limits: Policy::Respect, ..by(Method::Automatic, 1.0, 1e-2) };
    let run = run(&model, &[0.0], &[1.0], options);
    assert!(run.method == Method::RungeKutta4 && run.one_sided.is_none());
    assert!((run.stops[0].first - 0.3).abs() < 1e-12);
}
