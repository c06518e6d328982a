//! Trajectories of balls, free joints and floating bases: compared with differences, hinges, and closed-form motions.

use super::tests::{assert_rates, used};
use super::*;
use mozzi::model::description::{Joint, JointKind};
use mozzi::model::difference;
use mozzi::testing::{Random, floating_mixed_tree, mixed_tree, state};
use mozzi::{Description, Freedom, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Vec3};

/// ‖θ₁ ⊖ θ₀‖.
fn apart(model: &Model, theta0: &[f64], theta1: &[f64]) -> f64 {
    let mut way = vec![0.0; model.n()];
    difference(model, theta0, theta1, &mut way);
    way.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// A body on a ball or, for comparison, on a hinge about an axis through its centre.
fn top(kind: JointKind) -> Model {
    let body = SpatialInertia::new(1.0, Vec3([0.1, 0.0, 0.3]), Sym3::diagonal(0.3, 0.4, 0.2));
    let robot = Description::new("top").link("base", SpatialInertia::zero()).link("body", body);
    robot.joint(Joint::new("pivot", "base", "body", SE3::identity(), kind)).build().expect("sound")
}

fn quaternion(R: SO3) -> Vec<f64> {
    let (w, v) = R.quaternion();
    vec![w, v.0[0], v.0[1], v.0[2]]
}

#[test]
fn splines_meet_their_points_without_jumps() {
    let kinds = |model: &Model| model.places().iter().map(|place| place.freedom).collect::<Vec<_>>();
    let [fixed, floating] = [mixed_tree(4, 8, 0), floating_mixed_tree(3, 5, 0)];
    assert!(kinds(&fixed).contains(&Freedom::Ball) && kinds(&fixed).contains(&Freedom::Free), "{:?}", kinds(&fixed));
    for model in [fixed, floating] {
        let points: Vec<Vec<f64>> = (1..6).map(|seed| state(&model, seed)[0].clone()).collect();
        let s = [0.0, 0.2, 0.5, 0.6, 1.0];
        for ends in [Ends::Natural, Ends::AtRest] {
            let spline = Spline::new(&model, &s, &points, ends).expect("fine");
            for (&s, point) in s.iter().zip(&points) {
                let [before, now, after] = [s - 1e-9, s, s + 1e-9].map(|s| spline.at(s));
                let error = apart(&model, point, &now.theta);
                assert!(error < 1e-13, "{error:e} at {s}");
                if s > 0.0 && s < 1.0 {
                    let jump = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                    let bend = largest(&now.curvature);
                    assert!(jump(&before.slope, &after.slope) < 1e-8 * bend, "θ′ at {s}");
                    assert!(jump(&before.curvature, &after.curvature) < 1e-6 * bend, "θ″ at {s}");
                } else {
                    let end = if ends == Ends::AtRest { &now.slope } else { &now.curvature };
                    assert!(largest(end) < 1e-12 * largest(&spline.at(0.35).curvature), "{end:?}");
                }
            }
            let scale = largest(&spline.at(0.35).curvature);
            assert_rates(&model, &Timed::new(&spline, Profile::quintic(2.0).expect("fine")), 1e-7 * scale.max(100.0));
        }
    }
}

#[test]
fn lines_between_two_states_end_there() {
    let model = floating_mixed_tree(2, 6, 0);
    let [from, to] = [1, 2].map(|seed| state(&model, seed)[0].clone());
    let line = Line::new(&model, &from, &to).expect("fine");
    for profile in [Profile::cubic(1.5), Profile::quintic(1.5), Profile::trapezoidal_in(1.5, 0.25)] {
        let motion = Timed::new(&line, profile.expect("fine"));
        assert!(apart(&model, &from, &motion.at(0.0).theta) < 1e-14);
        assert!(apart(&model, &to, &motion.at(1.5).theta) < 1e-13);
        assert_rates(&model, &motion, 1e-5);
    }
}

#[test]
fn a_ball_that_turns_about_one_axis_moves_as_a_hinge() {
    let axis = Vec3([2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0]);
    let hinge = top(JointKind::Screw(ScrewAxis::new(axis.0, [0.0; 3]).expect("unit")));
    let ball = top(JointKind::Ball(Vec3([0.0; 3])));
    let start = SO3::exp(Vec3([0.4, -1.0, 0.3]));
    let angles = [0.0, 1.3, 0.9, -1.2, -3.5, -0.6];
    let times = [0.0, 0.5, 0.7, 1.6, 2.9, 4.0];
    let rates = [0.3, -0.2, 0.9, -1.0, 0.1, 0.6];
    let rows = |list: &[f64]| list.iter().map(|&x| vec![x]).collect::<Vec<_>>();
    let turned = |angle: f64| quaternion(start * SO3::exp(axis * angle));
    let points: Vec<_> = angles.iter().map(|&angle| turned(angle)).collect();
    let along = |list: &[f64]| list.iter().map(|&x| (axis * x).0.to_vec()).collect::<Vec<_>>();
    let bends: Vec<f64> = rates.iter().map(|x| 2.0 - x).collect();
    let table = |rate: bool, bend: bool| {
        let (hinges, balls) = ([rows(&rates), rows(&bends)], [along(&rates), along(&bends)]);
        let recorded = |model: &Model, theta: &[Vec<f64>], [first, second]: &[Vec<Vec<f64>>; 2]| {
            let (first, second) = (rate.then_some(&first[..]), bend.then_some(&second[..]));
            Recorded::new(model, &times, theta, first, second).expect("fine")
        };
        (recorded(&hinge, &rows(&angles), &hinges), recorded(&ball, &points, &balls))
    };
    for (hinged, balled) in [table(false, false), table(true, false), table(true, true)] {
        for k in 0..=80 {
            let t = 0.05 * f64::from(k);
            let (expected, found) = (hinged.at(t), balled.at(t));
            assert!(apart(&ball, &turned(expected.theta[0]), &found.theta) < 1e-13, "{t}");
            for (rate, found) in [(expected.dtheta[0], found.dtheta), (expected.ddtheta[0], found.ddtheta)] {
                let error = Vec3([found[0], found[1], found[2]]) - axis * rate;
                assert!(error.norm() < 1e-11 * rate.abs().max(1.0), "{t}: {found:?}, expected {:?}", axis * rate);
            }
        }
    }
}

#[test]
fn tables_of_a_known_motion_are_met_to_their_order() {
    // R = e^{[a]t} e^{[b]t}: ω = e^{−[b]t}a + b, ω̇ = e^{−[b]t}a × b
    let (a, b, ball) = (Vec3([0.5, -0.9, 0.9]), Vec3([1.1, 0.3, -0.7]), top(JointKind::Ball(Vec3([0.0; 3]))));
    let motion = |t: f64| {
        let seen = SO3::exp(b * -t) * a;
        (quaternion(SO3::exp(a * t) * SO3::exp(b * t)), (seen + b).0.to_vec(), seen.cross(b).0.to_vec())
    };
    let error = |pieces: u32, second: bool| {
        let times: Vec<f64> = (0..=pieces).map(|k| 2.0 * f64::from(k) / f64::from(pieces)).collect();
        let (mut theta, mut dtheta, mut ddtheta) = (vec![], vec![], vec![]);
        for (q, w, dw) in times.iter().map(|&t| motion(t)) {
            theta.push(q);
            dtheta.push(w);
            ddtheta.push(dw);
        }
        let second = second.then_some(&ddtheta[..]);
        let recorded = Recorded::new(&ball, &times, &theta, Some(&dtheta), second).expect("fine");
        let at = |t: f64| apart(&ball, &motion(t).0, &recorded.at(t).theta);
        (0..200).map(|k| at(2.0 * f64::from(k) / 199.0)).fold(0.0, f64::max)
    };
    for (second, order) in [(false, 4.0), (true, 6.0)] {
        let found = (error(8, second) / error(16, second)).log2();
        assert!((found - order).abs() < 0.4, "order {found}, expected {order}");
    }
}

#[test]
fn the_choice_of_the_world_frame_does_not_matter() {
    let (ball, turn) = (top(JointKind::Ball(Vec3([0.0; 3]))), SO3::exp(Vec3([0.3, 1.2, -2.0])));
    let mut random = Random(4);
    let points: Vec<SO3> = (0..5).map(|_| SO3::exp(Vec3(random.array()) * 2.0)).collect();
    let spline = |points: Vec<Vec<f64>>| Spline::through(&ball, &points, Ends::Natural).expect("fine");
    let here = spline(points.iter().map(|&R| quaternion(R)).collect());
    let there = spline(points.iter().map(|&R| quaternion(turn * R)).collect());
    for k in 0..=30 {
        let [a, b] = [&here, &there].map(|spline| spline.at(f64::from(k) / 30.0));
        let R = SO3::from_quaternion(a.theta[0], Vec3([a.theta[1], a.theta[2], a.theta[3]]));
        assert!(apart(&ball, &quaternion(turn * R), &b.theta) < 1e-12);
        assert!(a.slope.iter().zip(&b.slope).all(|(a, b)| (a - b).abs() < 1e-11));
        assert!(a.curvature.iter().zip(&b.curvature).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

/// A ball at the shoulder, a hinge at the elbow, a ball at the wrist, and a tip.
fn arm() -> Model {
    let at = |z: f64| SE3::translation([0.0, 0.0, z]);
    let body = SpatialInertia::new(1.0, Vec3([0.0, 0.0, 0.2]), Sym3::diagonal(0.02, 0.03, 0.01));
    let ball = |name: &str, parent: &str, child: &str, z: f64, effort: f64| {
        let mut joint = Joint::new(name, parent, child, at(z), JointKind::Ball(Vec3([0.0; 3])));
        (joint.limits.velocity, joint.limits.effort) = (Some(3.0), Some(effort));
        joint
    };
    let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("unit"));
    let mut elbow = Joint::new("elbow", "upper", "lower", at(0.4), axis);
    (elbow.limits.velocity, elbow.limits.effort) = (Some(3.0), Some(20.0));
    Description::new("arm")
        .link("base", SpatialInertia::zero())
        .link("upper", body)
        .link("lower", body)
        .link("hand", body * 0.3)
        .joint(ball("shoulder", "base", "upper", 0.0, 40.0))
        .joint(elbow)
        .joint(ball("wrist", "lower", "hand", 0.4, 8.0))
        .frame("tip", "hand", at(0.2))
        .build()
        .expect("sound")
}

#[test]
fn arms_with_balls_are_led_and_timed() {
    let model = arm();
    let limits = Limits { acceleration: vec![20.0; 7], ..Limits::of(&model) };
    let from = [quaternion(SO3::exp(Vec3([0.1, 0.4, 0.0]))), vec![1.1], quaternion(SO3::exp(Vec3([0.2, 0.3, 0.1])))];
    let via = [quaternion(SO3::exp(Vec3([-0.5, 0.8, 0.3]))), vec![0.7], quaternion(SO3::exp(Vec3([0.0, 0.9, 0.4])))];
    let to = [quaternion(SO3::exp(Vec3([0.4, 0.2, 0.9]))), vec![1.4], quaternion(SO3::exp(Vec3([-0.3, 0.1, 0.0])))];
    let [from, via, to] = [from, via, to].map(|parts| parts.concat());
    let frame = model.frame("tip").expect("named");
    let start = model.forward_kinematics(&from, frame).expect("lengths");
    let goal = SE3::new(start.R * SO3::exp(Vec3([0.2, 0.1, 0.4])), start.p + Vec3([-0.1, 0.2, 0.05]));
    let led = Cartesian::new(&model, frame, &from, goal, Shape::Straight, 1e-6).expect("within reach");
    for k in 0..=40 {
        let s = f64::from(k) / 40.0;
        let T = model.forward_kinematics(&led.at(s).theta, frame).expect("lengths");
        assert!((T.inverse() * Shape::Straight.at(start, goal, s)).log().norm() < 1.5e-6, "{s}");
    }
    let spline = Spline::through(&model, &[from.clone(), via, to.clone()], Ends::Natural).expect("fine");
    let line = Line::new(&model, &from, &to).expect("fine");
    for path in [&led as &dyn Path, &spline, &line] {
        let fastest = Timed::new(path, time_optimal(&model, &path, &limits, 300).expect("fine"));
        let shape = stretched(&model, &path, &Profile::quintic(1.0).expect("fine"), &limits, 900).expect("fine");
        for motion in [fastest.clone(), Timed::new(path, shape)] {
            let most = used(&model, &motion, &limits, 900).into_iter().fold(0.0, f64::max);
            assert!(most < 1.0005 && most > 0.995, "{most}");
        }
        assert_rates(&model, &Timed::new(path, Profile::quintic(2.0).expect("fine")), 1e-4);
    }
}
