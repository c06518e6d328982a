//! Rates compared with differences, splines with polynomials, time-optimal motions with closed-form solutions.

use super::*;
use crate::Error;
use mozzi::model::description::{Joint, JointKind};
use mozzi::model::difference;
use mozzi::testing::{Random, floating_tree, state, tree};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Twist, Vec3};

fn robot(name: &str) -> Model {
    mozzi_urdf::open(name).expect("embedded").build().expect("sound")
}

/// A point mass m at r, turning about y, hanging at θ = 0.
fn pendulum(m: f64, r: f64, damping: f64, friction: f64) -> Model {
    let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("unit"));
    let mut joint = Joint::new("pivot", "base", "bob", SE3::identity(), axis);
    (joint.damping, joint.friction) = (damping, friction);
    let bob = SpatialInertia::point_mass(m, Vec3([0.0, 0.0, -r]));
    Description::new("pendulum")
        .link("base", SpatialInertia::zero())
        .link("bob", bob)
        .joint(joint)
        .build()
        .expect("sound")
}

fn via_points(seed: u64, count: usize) -> Vec<Vec<f64>> {
    let mut random = Random(seed);
    (0..count).map(|_| random.vector(6, 1.5)).collect()
}

/// θ̇ and θ̈ of a motion against differences of θ and θ̇.
pub(super) fn assert_rates(model: &Model, motion: &impl Reference, tolerance: f64) {
    let (T, e, n) = (motion.duration(), 1e-5, model.n());
    for k in 0..20 {
        let t = T * (k as f64 + 0.37) / 20.3;
        let [before, now, after] = [t - e, t, t + e].map(|t| motion.at(t));
        let mut moved = vec![0.0; n];
        difference(model, &before.theta, &after.theta, &mut moved);
        for j in 0..n {
            assert!(
                (moved[j] / (2.0 * e) - now.dtheta[j]).abs() < tolerance,
                "{t} {j}: {} {}",
                moved[j] / (2.0 * e),
                now.dtheta[j]
            );
            let rate = (after.dtheta[j] - before.dtheta[j]) / (2.0 * e);
            assert!((rate - now.ddtheta[j]).abs() < tolerance, "{t} {j}: {rate} {}", now.ddtheta[j]);
        }
    }
}

#[test]
fn rates_are_derivatives() {
    let (ur5, free) = (robot("ur5"), floating_tree(3, 5, 1));
    let [[from, ..], [to, ..]] = [state(&free, 1), state(&free, 2)];
    let line = Line::new(&free, &from, &to).expect("fine");
    let mut reached = vec![0.0; free.n()];
    difference(&free, &line.at(1.0).theta, &to, &mut reached);
    let began = line.at(0.0).theta.iter().zip(&from).all(|(a, b)| (a - b).abs() < 1e-15);
    assert!(began && reached.iter().all(|x| x.abs() < 1e-13));
    assert_rates(&free, &Timed::new(line, Profile::quintic(1.5).expect("fine")), 1e-6);
    let points = via_points(1, 6);
    for ends in [Ends::Natural, Ends::AtRest] {
        let spline = Spline::through(&ur5, &points, ends).expect("fine");
        assert_rates(&ur5, &Timed::new(&spline, Profile::cubic(2.0).expect("fine")), 1e-5);
        let speed = |s: f64| spline.at(s).slope.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let bend = |s: f64| spline.at(s).curvature.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for s in [0.0, 1.0] {
            assert!(if ends == Ends::AtRest { speed(s) } else { bend(s) } < 1e-12);
        }
    }
    let times: Vec<f64> = (0..6).map(|k| 0.5 + 0.4 * k as f64).collect();
    let rates = via_points(2, 6);
    for recorded in [
        Recorded::new(&ur5, &times, &points, None, None),
        Recorded::new(&ur5, &times, &points, Some(&rates), None),
        Recorded::new(&ur5, &times, &points, Some(&rates), Some(&via_points(3, 6))),
    ] {
        assert_rates(&ur5, &recorded.expect("fine"), 1e-4);
    }
}

#[test]
fn polynomials_come_back() {
    let ur5 = robot("ur5");
    let s: Vec<f64> = vec![0.0, 0.15, 0.2, 0.7, 0.75, 1.0];
    // at rest at both ends: 3s² − 2s³
    let points: Vec<Vec<f64>> =
        s.iter().map(|s| (0..6).map(|j| 1.0 + j as f64 * (3.0 - 2.0 * s) * s * s).collect()).collect();
    let spline = Spline::new(&ur5, &s, &points, Ends::AtRest).expect("fine");
    for k in 0..=50 {
        let (s, point) = (k as f64 / 50.0, spline.at(k as f64 / 50.0));
        for j in 0..6 {
            let c = j as f64;
            let expected = [1.0 + c * (3.0 - 2.0 * s) * s * s, 6.0 * c * s * (1.0 - s), 6.0 * c * (1.0 - 2.0 * s)];
            for (x, y) in [point.theta[j], point.slope[j], point.curvature[j]].iter().zip(expected) {
                assert!((x - y).abs() < 1e-12, "{s} {j}: {x} {y}");
            }
        }
    }
    // tables with rates: a quintic of t from its values, slopes and curvatures; a cubic without the last
    let times = [0.2, 0.5, 1.1, 1.3];
    let quintic = |t: f64, j: usize, cubic: bool| {
        let c: [f64; 6] = [0.3, -1.0, j as f64, 0.5, if cubic { 0.0 } else { -0.7 }, if cubic { 0.0 } else { 0.4 }];
        let at = |f: &dyn Fn(i32) -> f64| (0..6).map(|k| c[k as usize] * f(k)).sum::<f64>();
        let power = |k: i32, less: i32| if k < less { 0.0 } else { t.powi(k - less) };
        [at(&|k| power(k, 0)), at(&|k| f64::from(k) * power(k, 1)), at(&|k| f64::from(k * (k - 1)) * power(k, 2))]
    };
    for cubic in [false, true] {
        let rows = |order: usize| -> Vec<Vec<f64>> {
            times.iter().map(|&t| (0..6).map(|j| quintic(t, j, cubic)[order]).collect()).collect()
        };
        let second = rows(2);
        let recorded =
            Recorded::new(&ur5, &times, &rows(0), Some(&rows(1)), (!cubic).then_some(&second[..])).expect("fine");
        for k in 0..=30 {
            let t = 0.2 + 1.1 * k as f64 / 30.0;
            let now = recorded.at(t);
            for j in 0..6 {
                for (x, y) in [now.theta[j], now.dtheta[j], now.ddtheta[j]].iter().zip(quintic(t, j, cubic)) {
                    assert!((x - y).abs() < 1e-11, "{t} {j}: {x} {y}");
                }
            }
        }
        // before and after it stays
        assert_eq!((recorded.at(0.1).theta, recorded.at(0.1).dtheta), (rows(0)[0].clone(), vec![0.0; 6]));
        assert_eq!((recorded.at(9.0).theta, recorded.at(9.0).dtheta), (rows(0)[3].clone(), vec![0.0; 6]));
    }
}

#[test]
fn the_hand_stays_on_its_path() {
    let panda = robot("panda").with_locked_joints(&[("panda_finger_joint1", 0.02)]).expect("sound");
    for (model, frame, from) in [
        (robot("ur5"), "tool0", vec![0.3, -1.2, 1.4, -0.5, 0.9, 2.0]),
        (panda, "panda_hand", vec![0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7]),
    ] {
        let frame = model.frame(frame).expect("there");
        let start = model.forward_kinematics(&from, frame).expect("lengths");
        let goal = SE3::new(
            (start * SE3::exp(Twist { w: Vec3([0.3, -0.4, 0.2]), v: Vec3::zero() })).R,
            start.p + Vec3([-0.1, 0.15, -0.1]),
        );
        for shape in [Shape::Screw, Shape::Straight] {
            let path = Cartesian::new(&model, frame, &from, goal, shape, 1e-6).expect("within reach");
            assert!(path.deviation <= 1e-6 && path.at(0.0).theta == from);
            for k in 0..=97 {
                let s = k as f64 / 97.0;
                let T = model.forward_kinematics(&path.at(s).theta, frame).expect("lengths");
                assert!((T.inverse() * shape.at(start, goal, s)).log().norm() < 1.5e-6, "{s}");
                if shape == Shape::Straight {
                    let (way, done) = (goal.p - start.p, T.p - start.p);
                    assert!(way.cross(done).dot(way.cross(done)).sqrt() < 1e-6 * way.dot(way).sqrt());
                }
                // a screw's twist, in its own coordinates, is the same all along
                let V = &model.body_jacobian(&path.at(s).theta, frame).expect("lengths") * &path.at(s).slope[..];
                let expected = (start.inverse() * goal).log();
                assert!(
                    shape != Shape::Screw || (V - expected).norm() < 2e-3 * expected.norm(),
                    "{s}: {V:?} {expected:?}"
                );
            }
            assert_rates(&model, &Timed::new(path, Profile::quintic(1.0).expect("fine")), 1e-4);
        }
        let far = Cartesian::new(&model, frame, &from, SE3::translation([2.0, 0.0, 0.0]), Shape::Straight, 1e-4);
        assert!(matches!(far, Err(Error::OffPath { s, .. }) if s > 0.0), "{far:?}");
    }
}

/// The largest share of a limit that a motion uses, at N + 1 times: velocity, acceleration, torque.
pub(super) fn used(model: &Model, motion: &impl Reference, limits: &Limits, steps: usize) -> [f64; 3] {
    let mut largest = [0.0_f64; 3];
    for (_, now) in motion.sampled(steps) {
        let tau = model.inverse_dynamics(&now.theta, &now.dtheta, &now.ddtheta, &model.environment()).expect("lengths");
        for j in 0..model.n() {
            largest[0] = largest[0].max(now.dtheta[j].abs() / limits.velocity[j]);
            largest[1] = largest[1].max(now.ddtheta[j].abs() / limits.acceleration[j]);
            largest[2] = largest[2].max(tau[j].abs() / limits.torque[j]);
        }
    }
    largest
}

#[test]
fn a_double_integrator_is_driven_bang_bang() {
    let robot = pendulum(2.0, 0.7, 0.0, 0.0).with_gravity([0.0; 3]).expect("sound");
    let (I, torque, way) = (2.0 * 0.49, 3.0, 1.7);
    let line = Line::new(&robot, &[0.2], &[0.2 + way]).expect("fine");
    let mut limits = Limits { torque: vec![torque], ..Limits::none(&robot) };
    let shortest = time_optimal(&robot, &line, &limits, 200).expect("fine");
    let expected = 2.0 * (way * I / torque).sqrt();
    assert!((shortest.duration() / expected - 1.0).abs() < 1e-9, "{} {expected}", shortest.duration());
    // with a speed limit: a trapezoid
    limits.velocity[0] = 1.1;
    let a = torque / I;
    let (shortest, expected) = (time_optimal(&robot, &line, &limits, 400).expect("fine"), way / 1.1 + 1.1 / a);
    assert!((shortest.duration() / expected - 1.0).abs() < 2e-3, "{} {expected}", shortest.duration());
    // the trapezoid of Profile is the same
    let trapezoid = Profile::trapezoidal(1.1 / way, a / way).expect("fine");
    assert!((trapezoid.duration() - expected).abs() < 1e-12);
    for k in 0..=20 {
        let t = expected * k as f64 / 20.0;
        assert!((trapezoid.at(t).s - shortest.at(t).s).abs() < 2e-3);
    }
}

#[test]
fn a_pendulum_swings_up_as_its_energy_says() {
    // ½ I θ̇² = ∫ (τ − m g r sin θ) dθ from the start, with −τ from the end: the least of both is the fastest
    let (m, r, torque, end) = (1.5, 0.6, 12.0, 2.5_f64);
    let robot = pendulum(m, r, 0.0, 0.0);
    let line = Line::new(&robot, &[0.0], &[end]).expect("fine");
    let limits = Limits { torque: vec![torque], ..Limits::none(&robot) };
    let shortest = time_optimal(&robot, &line, &limits, 500).expect("fine");
    let weight = |q: f64| m * 9.81 * r * q.cos();
    let (rise, fall) =
        (|q: f64| torque * q + weight(q) - weight(0.0), |q: f64| torque * (end - q) + weight(q) - weight(end));
    for k in 0..=200 {
        let now = shortest.at(shortest.duration() * k as f64 / 200.0);
        let q = now.s * end;
        let expected = (2.0 * rise(q).min(fall(q)).max(0.0) / (m * r * r)).sqrt();
        assert!((now.ds * end - expected).abs() < 0.02 * expected.max(1.0), "{q}: {} {expected}", now.ds * end);
    }
    let [_, _, share] = used(&robot, &Timed::new(&line, shortest), &limits, 700);
    assert!(share < 1.0001 && share > 0.9999, "{share}");
    // friction of both kinds: within the limit, and near it
    let robot = pendulum(m, r, 0.8, 0.5);
    let shortest = time_optimal(&robot, &line, &limits, 500).expect("fine");
    let [_, _, share] = used(&robot, &Timed::new(&line, shortest), &limits, 700);
    assert!(share < 1.0001 && share > 0.97, "{share}");
    // too weak to hold the robot on the way
    let weak = time_optimal(&robot, &line, &Limits { torque: vec![6.0], ..limits }, 500).expect_err("weak");
    let Error::TooWeak { joint, s, needed, limit } = &weak else { panic!("{weak:?}") };
    assert!(joint == "pivot" && *limit == 6.0 && *needed > 6.0 && *s > 0.2 && *s < 0.4, "{weak}");
}

/// A mimic joint's limits, through its ratio, are its source's.
#[test]
fn limits_of_mimic_joints_count() {
    let mut robot = robot("panda").description().clone();
    let finger = robot.joints.iter_mut().find(|joint| joint.mimic.is_some()).expect("a mimic joint");
    (finger.limits.velocity, finger.limits.acceleration) = (Some(0.1), Some(3.0));
    finger.mimic.as_mut().expect("one").ratio = -2.0;
    let model = robot.build().expect("sound");
    let limits = Limits::of(&model);
    let source = model.joint_names().position(|name| name == "panda_finger_joint1").expect("there");
    assert_eq!((limits.velocity[source], limits.acceleration[source]), (0.05, 1.5));
}

#[test]
fn the_fastest_way_keeps_all_limits_and_leaves_none_unused() {
    let ur5 = robot("ur5");
    let mut limits = Limits { acceleration: vec![15.0; 6], ..Limits::of(&ur5) };
    limits.torque.iter_mut().for_each(|x| *x *= 0.8);
    let points = vec![
        vec![0.0, -1.5, 1.5, 0.0, 0.5, 0.0],
        vec![0.5, -1.0, 0.8, 0.5, 1.0, 0.7],
        vec![1.5, -1.2, 1.0, -0.4, 0.2, 1.0],
        vec![1.0, -0.6, 0.4, 0.0, 0.0, 0.0],
    ];
    let spline = Spline::through(&ur5, &points, Ends::Natural).expect("fine");
    let profile = time_optimal(&ur5, &spline, &limits, 300).expect("fine");
    let fastest = Timed::new(&spline, profile);
    let share = used(&ur5, &fastest, &limits, 900);
    assert!(share.iter().all(|&x| x < 1.0001), "{share:?}");
    // at almost every time some limit is reached
    let T = fastest.duration();
    let busy = (1..100).filter(|&k| {
        let now = fastest.at(T * f64::from(k) / 100.0);
        let tau = ur5.inverse_dynamics(&now.theta, &now.dtheta, &now.ddtheta, &ur5.environment()).expect("lengths");
        let full = |x: f64, limit: f64| x.abs() > 0.97 * limit;
        (0..6).any(|j| {
            full(now.dtheta[j], limits.velocity[j])
                || full(now.ddtheta[j], limits.acceleration[j])
                || full(tau[j], limits.torque[j])
        })
    });
    assert!(busy.count() > 90);
    // twice as many intervals, the same time
    let again = time_optimal(&ur5, &spline, &limits, 600).expect("fine").duration();
    assert!((again / T - 1.0).abs() < 0.01, "{again} {T}");
    // slower shapes, stretched until they keep the same limits
    for shape in [Profile::cubic(1.0), Profile::quintic(1.0), Profile::trapezoidal_in(1.0, 0.2)] {
        let profile = stretched(&ur5, &spline, &shape.expect("fine"), &limits, 900).expect("fine");
        // at other times than those that were checked
        let share = used(&ur5, &Timed::new(&spline, profile.clone()), &limits, 20_011);
        let most = share.iter().fold(0.0_f64, |m, &x| m.max(x));
        assert!(most < 1.0 + 1e-9 && most > 0.999, "{share:?}");
        assert!(profile.duration() > T, "{} {T}", profile.duration());
    }
}

#[test]
fn demands_are_inverse_dynamics_along_the_path() {
    // with damping, Coulomb friction, springs and a mimic joint
    let model = tree(2, 6, 1);
    let n = model.n();
    let path = Line::new(&model, &vec![-0.4; n], &vec![0.9; n]).expect("fine");
    let (s, ds, dds) = (0.3, 0.7, -1.1);
    let (demand, point) = (super::demands::demands(&model, &path, &[s]).remove(0), path.at(s));
    let dtheta: Vec<f64> = point.slope.iter().map(|x| x * ds).collect();
    let ddtheta: Vec<f64> = point.slope.iter().zip(&point.curvature).map(|(x, y)| x * dds + y * ds * ds).collect();
    let tau = model.inverse_dynamics(&point.theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
    for j in 0..n {
        let found = demand.a[j] * dds + demand.b[j] * ds * ds + demand.c[j] + demand.d[j] * ds;
        assert!((found - tau[j]).abs() < 1e-12 * tau.amax(), "{j}: {found} {}", tau[j]);
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let (ur5, free) = (robot("ur5"), robot("ur5").with_base(mozzi::Base::Floating).expect("sound"));
    let words = |error: Error, words: &str| assert!(error.to_string().contains(words), "{error}");
    let points = via_points(1, 3);
    words(Spline::new(&ur5, &[0.0, 1.0], &points, Ends::Natural).expect_err("two"), "2 entries, expected 3");
    words(Spline::new(&ur5, &[0.0, 1.0, 1.0], &points, Ends::Natural).expect_err("twice"), "1 in row 3");
    words(Spline::through(&ur5, &points[..1], Ends::Natural).expect_err("one"), "at least 2");
    let twice = [points[0].clone(), points[1].clone(), points[1].clone()];
    words(Spline::through(&ur5, &twice, Ends::Natural).expect_err("twice"), "in row 3, as in the one before it");
    words(Spline::through(&free, &points, Ends::Natural).expect_err("free"), "6 entries, expected 13");
    words(Line::new(&ur5, &[0.0; 6], &[0.0; 5]).expect_err("five"), "5 entries, expected 6");
    words(Recorded::new(&ur5, &[0.0, 1.0, 2.0], &points, None, Some(&points)).expect_err("rates"), "θ̇ too");
    words(Recorded::new(&ur5, &[-1.0, 1.0, 2.0], &points, None, None).expect_err("early"), "first time is -1");
    let line = Line::new(&ur5, &[0.0; 6], &[1.0; 6]).expect("fine");
    let none = Limits::none(&ur5);
    let still = Line::new(&ur5, &[0.3; 6], &[0.3; 6]).expect("fine");
    words(time_optimal(&ur5, &still, &Limits::of(&ur5), 100).expect_err("still"), "along which something moves");
    words(time_optimal(&ur5, &line, &none, 100).expect_err("no limit"), "nothing limits the speed");
    words(
        stretched(&ur5, &line, &Profile::cubic(1.0).expect("fine"), &none, 100).expect_err("no limit"),
        "nothing limits",
    );
    words(
        time_optimal(&ur5, &line, &Limits { velocity: vec![1.0; 5], ..none.clone() }, 100).expect_err("five"),
        "expected 6",
    );
    words(
        time_optimal(&ur5, &line, &Limits { velocity: vec![-1.0; 6], ..none }, 100).expect_err("below 0"),
        "shoulder_pan_joint",
    );
}
