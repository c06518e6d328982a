//! Compared with forward kinematics: the embedded robots, and random ones.

use super::*;
use mozzi::model::description::{Joint, JointKind};
use mozzi::model::difference;
use mozzi::testing::{floating_tree, state, tree, twist};
use mozzi::{Description, SE3, SO3, SpatialInertia, Vec3};

fn robot(name: &str, frame: &str) -> (Model, FrameId) {
    let model = mozzi_urdf::open(name).expect("embedded").build().expect("sound");
    let frame = model.frame(frame).expect("there");
    (model, frame)
}

/// θ anywhere within the limits.
fn within(model: &Model, random: &mut Random) -> Vec<f64> {
    let mut theta = model.neutral_configuration();
    Bounds::of(model).randomize(&mut theta, random);
    theta
}

fn assert_within(model: &Model, theta: &[f64]) {
    let bounds = Bounds::of(model);
    for (k, &[low, high]) in bounds.joints.iter().enumerate() {
        let q = bounds.value(theta, k);
        assert!((low..=high).contains(&q), "{q} of {low} … {high}");
    }
}

const ROBOTS: [(&str, &str); 6] = [
    ("ur5", "tool0"),
    ("panda", "panda_hand"),
    ("anymal", "LF_FOOT"),
    ("double_pendulum", "tip"),
    ("furuta_pendulum", "tip"),
    ("two_link_planar", "tip"),
];

#[test]
fn poses_that_the_robots_reach_are_reached() {
    for (name, frame) in ROBOTS {
        let (model, frame) = robot(name, frame);
        let mut solver = InverseKinematics::new(&model, frame).expect("a frame");
        let mut random = Random(7);
        let guess = model.neutral_configuration::<f64>();
        for method in [Method::LevenbergMarquardt, Method::Newton] {
            solver.options.method = method;
            let (mut starts, mut iterations) = (0, 0);
            for _ in 0..20 {
                let goal = forward_kinematics(&model, &within(&model, &mut random), frame);
                let found = solver.solve(Goal::Pose(goal), &guess).unwrap_or_else(|error| panic!("{name}: {error}"));
                let T = forward_kinematics(&model, &found.theta, frame);
                let left = (SE3::new(T.R.inverse(), Vec3::zero()) * SE3::new(goal.R, Vec3::zero())).log();
                assert!(left.norm() < 2e-8 && (goal.p - T.p).dot(goal.p - T.p).sqrt() < 2e-8, "{name}: {left:?}");
                assert_within(&model, &found.theta);
                (starts, iterations) = (starts + found.starts, iterations + found.iterations);
            }
            println!(
                "{name:16} {method:?}: {:.1} starts, {:.1} iterations",
                starts as f64 / 20.0,
                iterations as f64 / 20.0
            );
        }
    }
}

#[test]
fn the_error_leads_to_the_goal_and_minus_the_jacobian_is_its_derivative() {
    let model = tree(3, 8, 1);
    let [theta, dtheta, _] = state(&model, 1);
    let frame = model.end_effector().expect("named");
    let at = |h: f64| {
        let mut moved = theta.clone();
        integrate(&model, &mut moved, &dtheta, h);
        forward_kinematics(&model, &moved, frame)
    };
    let T = at(0.0);
    let V = &model.body_jacobian(&theta, frame).expect("lengths") * &dtheta[..];
    let apart = T * SE3::exp(twist(5));
    for (goal, here) in [
        (Goal::Pose(apart), Goal::Pose(T)),
        (Goal::Position(apart.p), Goal::Position(T.p)),
        (Goal::Orientation(apart.R), Goal::Orientation(T.R)),
    ] {
        // moved along e the goal is reached
        let reached = match goal {
            Goal::Pose(_) => T * SE3::exp(goal.error(T)),
            // p and R separately
            _ => SE3::new(
                (SE3::new(T.R, Vec3::zero()) * SE3::exp(Twist { v: Vec3::zero(), ..goal.error(T) })).R,
                T * goal.error(T).v,
            ),
        };
        assert!(goal.error(reached).norm() < 1e-13);
        // at the goal
        let rate = (here.error(at(1e-5)) - here.error(at(-1e-5))) * (0.5 / 1e-5);
        for row in 0..6 {
            let expected = if here.rows().contains(&row) { -V.to_array()[row] } else { 0.0 };
            assert!((rate.to_array()[row] - expected).abs() < 1e-7 * (1.0 + V.norm()), "{here:?} row {row}");
        }
    }
}

#[test]
fn positions_and_orientations_alone() {
    let (model, frame) = robot("panda", "panda_hand");
    let mut solver = InverseKinematics::new(&model, frame).expect("a frame");
    let mut random = Random(3);
    for _ in 0..10 {
        let T = forward_kinematics(&model, &within(&model, &mut random), frame);
        let guess = within(&model, &mut random);
        let found = solver.solve(Goal::Position(T.p), &guess).expect("reached");
        let apart = forward_kinematics(&model, &found.theta, frame).p - T.p;
        assert!(apart.dot(apart).sqrt() < 1e-8 && found.residual.angle.is_none());
        let found = solver.solve(Goal::Orientation(T.R), &guess).expect("reached");
        let R = forward_kinematics(&model, &found.theta, frame).R;
        let apart = (R.matrix() - T.R.matrix()).rows().as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(apart < 1e-8 && found.residual.distance.is_none());
    }
}

#[test]
fn out_of_reach_is_said_with_the_numbers() {
    let (model, frame) = robot("ur5", "tool0");
    let mut solver =
        InverseKinematics::with_options(&model, frame, Options { starts: 3, ..Options::default() }).expect("fine");
    let error = solver.solve(Goal::Position(Vec3([3.0, 0.0, 0.0])), &[0.0; 6]).expect_err("too far");
    let Error::NotReached { residual, theta, starts: 3, .. } = &error else { panic!("{error:?}") };
    // stretched out towards it
    let p = forward_kinematics(&model, theta, frame).p;
    let distance = residual.distance.expect("asked for");
    assert!((distance - (Vec3([3.0, 0.0, 0.0]) - p).dot(Vec3([3.0, 0.0, 0.0]) - p).sqrt()).abs() < 1e-12);
    assert!(distance > 1.9 && distance < 2.2, "{distance}");
    assert!(error.to_string().starts_with("frame `tool0` did not reach its goal: the best of 3 starts"), "{error}");

    // within reach, but not within the limits: the slide of a Panda's finger
    let (panda, finger) = robot("panda", "panda_leftfinger");
    let locked: Vec<(&str, f64)> = panda.joint_names().take(7).map(|name| (name, 0.1)).collect();
    let slide = panda.with_locked_joints(&locked).expect("sound");
    let finger = slide.frame(panda.frame_name(finger)).expect("there");
    let goal = Goal::Position(forward_kinematics(&slide, &[0.06], finger).p);
    let error =
        InverseKinematics::new(&slide, finger).expect("fine").solve(goal, &[0.0]).expect_err("at 0.04 m it ends");
    let Error::NotReached { limits, residual, .. } = &error else { panic!("{error:?}") };
    assert!(limits == &["panda_finger_joint1"] && (residual.distance.expect("asked for") - 0.02).abs() < 1e-9);
    let free = Options { limits: false, ..Options::default() };
    let found =
        InverseKinematics::with_options(&slide, finger, free).expect("fine").solve(goal, &[0.0]).expect("unlimited");
    assert!((found.theta[0] - 0.06).abs() < 1e-8);
}

#[test]
fn a_secondary_goal_chooses_among_the_solutions() {
    let (model, frame) = robot("panda", "panda_hand");
    let model = model.with_locked_joints(&[("panda_finger_joint1", 0.02)]).expect("sound");
    let frame = model.frame(robot("panda", "panda_hand").0.frame_name(frame)).expect("there");
    let posture = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let goal = Goal::Pose(forward_kinematics(&model, &[0.5, -0.3, -0.4, -1.7, 0.1, 1.5, 1.0], frame));
    let mut solver = InverseKinematics::new(&model, frame).expect("fine");
    let plain = solver.solve(goal, &[0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0]).expect("reached");
    let near =
        solver.solve_with(goal, &[0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0], &Secondary::Near(&posture)).expect("reached");
    let away = |theta: &[f64]| theta.iter().zip(&posture).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    assert!(away(&near.theta) < away(&plain.theta));
    // stationary: θ − θ_r has no part in the null space, which is found here by the singular vectors of J
    let J = model.body_jacobian(&near.theta, frame).expect("lengths").matrix();
    let null = J.clone().resize(7, 7, 0.0).svd(false, true).v_t.expect("asked for").row(6).transpose();
    assert!((J * &null).amax() < 1e-12);
    let mut apart = vec![0.0; 7];
    difference(&model, &posture, &near.theta, &mut apart);
    let along: f64 = null.iter().zip(&apart).map(|(a, b)| a * b).sum();
    assert!(along.abs() < 1e-6, "{along:e}");
    // the same by a function
    let H = |theta: &[f64], gradient: &mut [f64]| {
        for j in 0..7 {
            gradient[j] = theta[j] - posture[j];
        }
        0.5 * away(theta)
    };
    let again =
        solver.solve_with(goal, &[0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0], &Secondary::Minimize(&H)).expect("reached");
    assert!(again.theta.iter().zip(&near.theta).all(|(a, b)| (a - b).abs() < 1e-9));
}

/// The remaining distance is that of the origins, not the length of a screw; joints that do not move the frame stay.
#[test]
fn what_is_left_is_a_distance_and_idle_joints_stay() {
    let (model, tip) = robot("two_link_planar", "tip");
    let goal = SE3::new(SO3::from_rpy(2.5, 0.0, 0.0), Vec3([1.0, 0.5, 0.0]));
    let error = InverseKinematics::new(&model, tip).expect("sound").solve(Goal::Pose(goal), &[0.0, 0.0]);
    let Err(Error::NotReached { theta, residual, .. }) = error else { panic!("reached: {error:?}") };
    let T = model.forward_kinematics(&theta, tip).expect("sound");
    assert!((residual.distance.expect("a pose") - (goal.p - T.p).norm()).abs() < 1e-14);
    assert!((residual.angle.expect("a pose") - (T.R.inverse() * goal.R).log().norm()).abs() < 1e-14);

    let (model, hand) = robot("panda", "panda_hand");
    let finger = model.joint_names().position(|name| name == "panda_finger_joint1").expect("there");
    let mut random = Random(3);
    let mut several = 0;
    for _ in 0..20 {
        let goal = Goal::Pose(model.forward_kinematics(&within(&model, &mut random), hand).expect("sound"));
        let mut guess = model.start().theta;
        guess[finger] = 0.01;
        let found = InverseKinematics::new(&model, hand).expect("sound").solve(goal, &guess).expect("reached");
        assert_eq!(found.theta[finger], 0.01);
        several += usize::from(found.starts > 1);
    }
    assert!(several > 0);
}

#[test]
fn iterations_are_counted() {
    let (model, tip) = robot("ur5", "tool0");
    for most in [1, 3] {
        let options = Options { starts: 1, iterations: most, ..Options::default() };
        let error = InverseKinematics::with_options(&model, tip, options)
            .expect("sound")
            .solve(Goal::Position(Vec3([0.4, 0.2, 0.5])), &[0.0; 6]);
        assert!(matches!(error, Err(Error::NotReached { iterations, .. }) if iterations == most), "{error:?}");
    }
}

#[test]
fn a_free_base_moves_along() {
    let model = floating_tree(5, 6, 1);
    let frame = model.end_effector().expect("named");
    let [theta, ..] = state(&model, 2);
    let goal = SE3::exp(twist(9) * 2.0);
    let found = InverseKinematics::new(&model, frame).expect("fine").solve(Goal::Pose(goal), &theta).expect("reached");
    assert!((forward_kinematics(&model, &found.theta, frame).inverse() * goal).log().norm() < 1e-7);
    assert!((found.theta[..4].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
}

/// A ball with a tip 0.4 m along z; with `wrist`, another ball there, 0.3 m from the tip then.
fn on_balls(limit: f64, wrist: bool) -> Model {
    let ball = |name: &str, parent: &str, child: &str, z: f64| {
        let origin = SE3::new(mozzi::SO3::identity(), Vec3([0.0, 0.0, z]));
        let mut joint = Joint::new(name, parent, child, origin, JointKind::Ball(Vec3([0.0; 3])));
        joint.limits.position = Some([0.0, limit]);
        joint
    };
    let body = SpatialInertia::point_mass(1.0, Vec3([0.0, 0.0, 0.2]));
    let robot = Description::new("arm").link("base", SpatialInertia::zero()).link("upper", body);
    let robot = robot.joint(ball("shoulder", "base", "upper", 0.0));
    let (robot, last) = match wrist {
        true => (robot.link("lower", body).joint(ball("wrist", "upper", "lower", 0.4)), "lower"),
        false => (robot, "upper"),
    };
    let tip = SE3::new(mozzi::SO3::identity(), Vec3([0.0, 0.0, 0.4]));
    robot.frame("tip", last, tip).build().expect("sound")
}

#[test]
fn balls_stay_within_their_cones() {
    let model = on_balls(0.6, true);
    let frame = model.frame("tip").expect("named");
    let mut solver = InverseKinematics::new(&model, frame).expect("a frame");
    let (mut random, guess) = (Random(5), model.neutral_configuration::<f64>());
    for _ in 0..40 {
        let T = forward_kinematics(&model, &within(&model, &mut random), frame);
        for goal in [Goal::Pose(T), Goal::Position(T.p), Goal::Orientation(T.R)] {
            let found = solver.solve(goal, &guess).unwrap_or_else(|error| panic!("{error}"));
            assert_within(&model, &found.theta);
        }
    }
    // an orientation beyond both cones, by 0.2 rad
    let goal = Goal::Orientation(mozzi::SO3::exp(Vec3([1.4, 0.0, 0.0])));
    let Err(Error::NotReached { theta, residual, limits, .. }) = solver.solve(goal, &guess) else {
        panic!("it is not to be reached")
    };
    assert_within(&model, &theta);
    assert!((residual.angle.expect("of an orientation") - 0.2).abs() < 1e-6, "{residual}");
    assert_eq!(limits, ["shoulder", "wrist"]);
}

#[test]
fn a_secondary_goal_follows_a_cone() {
    // the tip fixes the ball but for its turn ψ about z, which is to be 2 rad: as much as the cone lets it
    let model = on_balls(0.8, false);
    let frame = model.frame("tip").expect("named");
    let tilt = mozzi::SO3::exp(Vec3([0.3, 0.4, 0.0]));
    let turned = |psi: f64| {
        let (w, v) = (tilt * mozzi::SO3::exp(Vec3([0.0, 0.0, psi]))).quaternion();
        vec![w, v.0[0], v.0[1], v.0[2]]
    };
    let reference = turned(2.0);
    let goal = Goal::Position(forward_kinematics(&model, &turned(0.0), frame).p);
    let mut solver = InverseKinematics::new(&model, frame).expect("a frame");
    let found = solver.solve_with(goal, &turned(0.1), &Secondary::Near(&reference)).expect("reached");
    let distance = |theta: &[f64]| {
        let mut way = [0.0; 3];
        difference(&model, theta, &reference, &mut way);
        Vec3(way).norm()
    };
    let bounds = Bounds::of(&model);
    let turns = (0..=20_000).map(|k| turned(1e-4 * f64::from(k))).filter(|theta| bounds.value(theta, 0) <= 0.8);
    let nearest = turns.map(|theta| distance(&theta)).fold(f64::INFINITY, f64::min);
    assert_within(&model, &found.theta);
    assert!((distance(&found.theta) - nearest).abs() < 1e-4, "{} {nearest}", distance(&found.theta));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let (model, frame) = robot("ur5", "tool0");
    let mut solver = InverseKinematics::new(&model, frame).expect("fine");
    let goal = Goal::Pose(SE3::identity());
    let message = |error: Error| error.to_string();
    assert!(message(solver.solve(goal, &[0.0; 5]).expect_err("five")).contains("5 entries, expected 6"));
    assert!(message(solver.solve(goal, &[f64::NAN; 6]).expect_err("NaN")).contains("the guess"));
    let nowhere = Goal::Position(Vec3([0.0, f64::INFINITY, 0.0]));
    assert!(message(solver.solve(nowhere, &[0.0; 6]).expect_err("infinite")).contains("the goal"));
    let bad = |options| message(InverseKinematics::with_options(&model, frame, options).expect_err("bad"));
    assert!(bad(Options { starts: 0, ..Options::default() }).contains("starts is 0"));
    assert!(bad(Options { angle: 0.0, ..Options::default() }).contains("angle is 0"));
    let other = robot("panda", "panda_rightfinger").1;
    assert!(InverseKinematics::new(&robot("two_link_planar", "tip").0, other).is_err());
    let bars = mozzi::testing::four_bar();
    let error = InverseKinematics::new(&bars, bars.frame("coupler").expect("a link")).expect_err("its loop would open");
    assert!(error.to_string().contains("with 5 constraint rows, expected a robot without constraints"), "{error}");
}
