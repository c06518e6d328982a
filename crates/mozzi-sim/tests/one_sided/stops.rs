//! Stops as impulses, next to dry friction.

use super::robots::{block, by};
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3};
use mozzi_sim::{Friction, Method, Options, Policy, Simulation, Trajectory, Zero, torque};

#[test]
fn a_block_is_pushed_against_its_stop_and_pulled_away() {
    // 2 kg, friction 1 N, pushed by 5 N from 0 to a stop at 0.3 m, from 1 s on pulled by 3 N
    let model = block(2.0, 0.0, 1.0, Some([-1.0, 0.3]));
    let motor = || torque(|t, _, _, tau| tau[0] += if t < 1.0 { 5.0 } else { -3.0 });
    {
        let (method, bound) = (Method::Automatic, 1e-3);
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
fn smooth_methods_refuse_what_they_have_not() {
    let smooth = [
        Method::Euler,
        Method::SemiImplicitEuler,
        Method::RungeKutta4,
        Method::Midpoint,
        Method::DormandPrince { tolerance: 1e-9 },
    ];
    for method in smooth {
        // a stop is an error when it acts, with the motion until then
        let model = block(2.0, 0.0, 0.0, Some([-1.0, 0.3]));
        let options = Options { joint_limits: Policy::Respect, ..by(method, 1.0, 1e-2) };
        let mut rows = Trajectory::new(&model);
        let go_on = |_| std::ops::ControlFlow::Continue(());
        let error = Simulation::new(options).stream(&model, &[0.0], &[1.0], Zero, &mut rows, go_on);
        let error = error.expect_err("a stop").to_string();
        assert!(error.contains("`slide` reaches its limit 0.3 at t = 0.3") && error.contains("`moreau`"), "{error}");
        assert_eq!(rows.len(), 30);
        // dry friction at once
        let model = block(2.0, 0.0, 1.0, None);
        let error = Simulation::new(by(method, 1.0, 1e-2)).run(&model, &[0.0], &[1.0], Zero).expect_err("refused");
        let error = error.to_string();
        assert!(error.contains(method.name()) && error.contains("dry friction of `slide`"), "{error}");
        let smooth = Friction::Smooth { slip_speed: 1e-2 };
        let run = Simulation::new(Options { friction: smooth, ..by(method, 0.1, 1e-3) });
        assert!(run.run(&model, &[0.0], &[1.0], Zero).expect("a motion").motion.complete);
    }
}

#[test]
fn limits_that_are_respected_make_the_method_moreaus() {
    for (limits, policy, expected) in [
        (Some([-1.0, 0.3]), Policy::Respect, Method::MoreauJean),
        (Some([-1.0, 0.3]), Policy::Report, Method::RungeKutta4),
        (None, Policy::Respect, Method::RungeKutta4),
    ] {
        let options = Options { joint_limits: policy, ..by(Method::Automatic, 1.0, 1e-3) };
        let run = Simulation::new(options).run(&block(2.0, 0.0, 0.0, limits), &[0.0], &[1.0], Zero).expect("a motion");
        assert_eq!(run.method, expected);
        if expected == Method::MoreauJean {
            assert!((run.stops[0].first - 0.3).abs() < 2e-3 && (run.motion.last().theta[0] - 0.3).abs() < 1e-12);
        }
    }
}

#[test]
fn a_start_beyond_a_limit_is_reported_at_once() {
    let options = by(Method::RungeKutta4, 0.1, 1e-3);
    let model = block(2.0, 0.0, 0.0, Some([-1.0, 0.3]));
    let run = Simulation::new(options).run(&model, &[0.5], &[0.0], Zero).expect("a motion");
    let stop = &run.stops[0];
    assert!(stop.first == 0.0 && stop.limit == 0.3 && (stop.beyond - 0.2).abs() < 1e-12, "{stop:?}");
}

/// Three axes without inertia between them, of which two align at the middle one's stop: there a joint becomes as fast
/// as it likes within a step, and the others' stops hold it.
#[test]
fn a_gimbal_stays_within_its_stops() {
    let body = SpatialInertia::new(4.0, Vec3([0.0, 0.1, 0.02]), Sym3::diagonal(0.02, 0.01, 0.02));
    let limit = std::f64::consts::FRAC_PI_2 + 4e-6; // as files round it
    let turn = |name: &str, parent: &str, child: &str, axis: [f64; 3]| {
        let axis = JointKind::Screw(ScrewAxis::new(axis, [0.0; 3]).expect("unit"));
        let mut joint = Joint::new(name, parent, child, SE3::identity(), axis);
        joint.limits.position = Some([-limit, limit]);
        joint
    };
    let model = ["w", "v1", "v2"]
        .into_iter()
        .fold(Description::new("gimbal"), |robot, name| robot.link(name, SpatialInertia::zero()))
        .link("head", body)
        .joint(turn("z", "w", "v1", [0.0, 0.0, -1.0]))
        .joint(turn("x", "v1", "v2", [1.0, 0.0, 0.0]))
        .joint(turn("y", "v2", "head", [0.0, 1.0, 0.0]))
        .build()
        .expect("sound");
    let options = Options { joint_limits: Policy::Respect, ..by(Method::MoreauJean, 2.0, 1e-3) };
    for k in 0..20 {
        let part = |a: f64| (a * f64::from(k) + 0.3).sin();
        let theta = [1.4 * part(1.1), 1.4 * part(1.7), 1.4 * part(2.3)];
        let dtheta = [7.0 * part(2.9), 7.0 * part(3.1), 7.0 * part(3.7)];
        let run = Simulation::new(options).run(&model, &theta, &dtheta, Zero).expect("a motion");
        let first = run.motion.samples().next().expect("a row").energy.total();
        for row in run.motion.samples() {
            let farthest = row.theta.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(farthest < limit + 1e-4, "{k}: {:?} at {} s", row.theta, row.t);
            assert!(row.energy.total() < first + 1e-2, "{k}: {} J of {first} at {} s", row.energy.total(), row.t);
        }
    }
}
