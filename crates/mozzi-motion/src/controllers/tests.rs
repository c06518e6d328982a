//! Properties of the controllers: error dynamics, at random states and over time.

use super::*;
use crate::Policy;
use crate::trajectories::{Hold, Line, Profile, Reference, Timed};
use mozzi::model::integrate;
use mozzi::testing::{state, tree, wrench};
use mozzi::{SE3, SpatialInertia, Task, TaskFrame, Twist, Vec3, Wrench};
use mozzi_sim::{ContactPoint, Input, Options, applied};

fn robot(name: &str) -> Model {
    mozzi_urdf::open(name).expect("embedded").build().expect("sound")
}

fn seven() -> Model {
    robot("panda").with_locked_joints(&[("panda_finger_joint1", 0.02)]).expect("sound")
}

fn torque(input: &mut impl Input, t: f64, theta: &[f64], dtheta: &[f64]) -> Vec<f64> {
    let mut tau = vec![0.0; dtheta.len()];
    input.torque(t, theta, dtheta, &mut tau).expect("regular");
    tau
}

/// θ̈ of the robot under an input.
fn acceleration(model: &Model, input: &mut impl Input, t: f64, theta: &[f64], dtheta: &[f64]) -> Vec<f64> {
    let tau = torque(input, t, theta, dtheta);
    model.forward_dynamics(theta, dtheta, &tau, &model.environment()).expect("regular").as_slice().to_vec()
}

#[test]
fn computed_torque_makes_the_error_linear() {
    // at any state, with mimic joints and friction: θ̈ = θ̈_d + K_d ė + K_p e
    let model = tree(4, 7, 1);
    let [from, ..] = state(&model, 1);
    let [to, ..] = state(&model, 2);
    let motion = Timed::new(Line::new(&model, &from, &to).expect("fine"), Profile::quintic(2.0).expect("fine"));
    let n = model.n();
    let gains = Gains { p: (0..n).map(|j| 50.0 + j as f64).collect(), d: (0..n).map(|j| 10.0 + j as f64).collect() };
    let mut control = ComputedTorque::new(&model, &motion, gains.clone()).expect("fine");
    let [theta, dtheta, _] = state(&model, 3);
    for t in [0.0, 0.7, 1.9, 3.0] {
        let (found, now) = (acceleration(&model, &mut control, t, &theta, &dtheta), motion.at(t));
        for j in 0..n {
            let expected =
                now.ddtheta[j] + gains.d[j] * (now.dtheta[j] - dtheta[j]) + gains.p[j] * (now.theta[j] - theta[j]);
            assert!((found[j] - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{t} {j}: {} {expected}", found[j]);
        }
    }
    // over time: e = (e₀ + (ė₀ + ωe₀)t) e^{−ωt}
    let (ur5, omega) = (robot("ur5"), 8.0);
    let [from, to] = [[0.0, -1.2, 1.5, 0.3, 1.1, 0.0], [1.0, -0.7, 0.8, -0.3, 0.4, 1.0]];
    let motion = Timed::new(Line::new(&ur5, &from, &to).expect("fine"), Profile::quintic(0.6).expect("fine"));
    let start: Vec<f64> = from.iter().enumerate().map(|(j, q)| q + 0.1 * j as f64 - 0.2).collect();
    let control = ComputedTorque::new(&ur5, &motion, Gains::critical(6, omega)).expect("fine");
    let followed = mozzi_sim::simulate(&ur5, &start, &[0.3; 6], control, &Options::new(0.6, 300)).expect("a motion");
    for row in followed.samples().step_by(50) {
        for j in 0..6 {
            let (e0, de0) = (from[j] - start[j], -0.3);
            let expected = (e0 + (de0 + omega * e0) * row.t) * (-omega * row.t).exp();
            let e = motion.at(row.t).theta[j] - row.theta[j];
            assert!((e - expected).abs() < 1e-7, "{} {j}: {e} {expected}", row.t);
        }
    }
    assert!((tracking_error(&ur5, &followed, &motion).worst() - 0.3).abs() < 0.02);
}

#[test]
fn pd_with_gravity_brings_the_robot_to_rest_at_its_goal() {
    // 𝒦 + ½ eᵀK_p e never grows, and the robot ends where it should
    let panda = seven();
    let goal = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let start = [0.0, -0.3, 0.0, -1.6, 0.0, 1.5, 0.4];
    let gains =
        Gains { p: vec![300.0, 300.0, 200.0, 200.0, 40.0, 40.0, 20.0], d: vec![60.0, 60.0, 40.0, 40.0, 6.0, 6.0, 2.0] };
    let mut control = PdGravity::new(&panda, Hold::new(&goal, 7), gains.clone()).expect("fine");
    let settled =
        mozzi_sim::simulate(&panda, &start, &[0.0; 7], &mut control, &Options::new(2.5, 2500)).expect("a motion");
    let stored = |k: usize| {
        let row = settled.sample(k);
        let spring: f64 = (0..7).map(|j| 0.5 * gains.p[j] * (goal[j] - row.theta[j]).powi(2)).sum();
        row.energy.kinetic + spring
    };
    assert!((1..settled.len()).all(|k| stored(k) <= stored(k - 1) + 1e-9));
    let last = settled.last();
    assert!(last.theta.iter().zip(&goal).all(|(a, b)| (a - b).abs() < 2e-2), "{:?}", last.theta);
    assert!(stored(settled.len() - 1) < 0.01 * stored(0));
    // a payload that the model does not have: the arm hangs where the springs carry it, K_p e = the payload's torques
    let hand = panda.frame("panda_hand").expect("there");
    let loaded = panda.with_payload(hand, SpatialInertia::point_mass(2.0, Vec3([0.0, 0.0, 0.1]))).expect("sound");
    let sagged =
        mozzi_sim::simulate(&loaded, &goal, &[0.0; 7], &mut control, &Options::new(6.0, 6000)).expect("a motion");
    let theta = sagged.last().theta;
    let missing = loaded.gravity_forces(theta).expect("lengths") - panda.gravity_forces(theta).expect("lengths");
    for j in 0..7 {
        assert!(
            (gains.p[j] * (goal[j] - theta[j]) - missing[j]).abs() < 0.02,
            "{j}: {} {}",
            gains.p[j] * (goal[j] - theta[j]),
            missing[j]
        );
    }
}

#[test]
fn a_frame_follows_as_its_law_says() {
    for (model, frame) in [(robot("ur5"), "tool0"), (seven(), "panda_hand")] {
        let (n, frame) = (model.n(), model.frame(frame).expect("there"));
        let from: Vec<f64> = [0.3, -0.9, 0.8, -1.5, 0.9, 1.6, 0.7][..n].to_vec();
        let to: Vec<f64> = from.iter().enumerate().map(|(j, q)| q + 0.1 * (j as f64 - 2.0)).collect();
        let motion = Timed::new(Line::new(&model, &from, &to).expect("fine"), Profile::quintic(0.8).expect("fine"));
        let theta: Vec<f64> = from.iter().map(|q| q + 0.07).collect();
        let dtheta: Vec<f64> = (0..n).map(|j| 0.3 - 0.1 * j as f64).collect();
        let (p, d) = ([90.0, 80.0, 70.0, 100.0, 110.0, 120.0], [20.0, 19.0, 18.0, 17.0, 16.0, 15.0]);
        let posture = Gains::critical(n, 5.0);
        let mut control =
            TaskSpace::new(&model, &motion, frame, Law::Acceleration { p, d }, posture.clone()).expect("fine");
        let t = 0.3;
        let ddtheta = acceleration(&model, &mut control, t, &theta, &dtheta);
        // X_e and 𝒱_e of the moving robot relative to the moving reference, by kinematics alone
        let errors = |h: f64| {
            let (mut q, mut now) = (theta.clone(), motion.at(t + h));
            let middle: Vec<f64> = dtheta.iter().zip(&ddtheta).map(|(v, a)| v + 0.5 * a * h).collect();
            integrate(&model, &mut q, &middle, h);
            let v: Vec<f64> = dtheta.iter().zip(&ddtheta).map(|(v, a)| v + a * h).collect();
            let pose = |q: &[f64]| model.forward_kinematics(q, frame).expect("lengths");
            let twist = |q: &[f64], v: &[f64]| &model.body_jacobian(q, frame).expect("lengths") * v;
            let T: SE3 = pose(&q).inverse() * pose(&now.theta);
            let V: Twist = T.Ad() * twist(&now.theta, &now.dtheta) - twist(&q, &v);
            now.theta.clear();
            (T.log(), V)
        };
        let ((X, V), e) = (errors(0.0), 1e-5);
        let rate = (errors(e).1 - errors(-e).1) * (0.5 / e);
        for r in 0..6 {
            let expected = -d[r] * V.to_array()[r] - p[r] * X.to_array()[r];
            assert!((rate.to_array()[r] - expected).abs() < 1e-4, "{r}: {} {expected}", rate.to_array()[r]);
        }
        // the book's Jᵀ(Λa + η) if J is square
        if n == 6 {
            let task = Task::all(frame, TaskFrame::Body);
            let found = model.task_space_dynamics(&theta, &dtheta, task, &model.environment()).expect("regular");
            let a = &found.J * mozzi::nalgebra::DVector::from_column_slice(&ddtheta) + &found.dJ_dtheta;
            let tau = found.J.transpose() * found.wrench(&a);
            let friction =
                model.joint_friction(&dtheta).expect("lengths") + model.spring_forces(&theta).expect("lengths");
            let given = torque(&mut control, t, &theta, &dtheta);
            assert!((0..6).all(|j| (given[j] - tau[j] - friction[j]).abs() < 1e-8), "{given:?} {tau}");
        } else {
            // in addition to the task, the posture: J⁺-free, the part of θ̈ − z in the null space, M-orthogonal to it,
            // is 0
            let now = motion.at(t);
            let z = (0..n).map(|j| {
                now.ddtheta[j] + posture.d[j] * (now.dtheta[j] - dtheta[j]) + posture.p[j] * (now.theta[j] - theta[j])
            });
            let J = model.body_jacobian(&theta, frame).expect("lengths").matrix();
            let null = J.resize(7, 7, 0.0).svd(false, true).v_t.expect("asked for").row(6).transpose();
            let apart = mozzi::nalgebra::DVector::from_iterator(n, ddtheta.iter().zip(z).map(|(a, z)| a - z));
            let M = model.mass_matrix(&theta).expect("lengths");
            assert!((null.transpose() * M * &apart)[0].abs() < 1e-9 * apart.norm());
        }
    }
}

#[test]
fn an_impedance_yields_as_a_spring() {
    let model = seven();
    let frame = model.frame("panda_hand").expect("there");
    let posture = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let law = Law::Impedance {
        stiffness: [20.0, 20.0, 20.0, 800.0, 800.0, 800.0],
        damping: [1.5, 1.5, 1.5, 80.0, 80.0, 80.0],
    };
    let control = TaskSpace::new(&model, Hold::new(&posture, 7), frame, law, Gains::critical(7, 10.0)).expect("fine");
    let push = Wrench { m: Vec3([1.0, -2.0, 0.5]), f: Vec3([10.0, 6.0, -12.0]) };
    let held = mozzi_sim::simulate(
        &model,
        &posture,
        &[0.0; 7],
        (control, applied(frame, move |_, _, _| push)),
        &Options::new(3.0, 1500),
    )
    .expect("a motion");
    let T = |theta: &[f64]| model.forward_kinematics(theta, frame).expect("lengths");
    let X = (T(held.last().theta).inverse() * T(&posture)).log();
    let (X, F) = (X.to_array(), [push.m.0, push.f.0].concat());
    for r in 0..6 {
        let stiffness = if r < 3 { 20.0 } else { 800.0 };
        assert!((stiffness * X[r] - F[r]).abs() < 0.02, "{r}: {} {}", stiffness * X[r], F[r]);
    }
}

#[test]
fn motors_have_limits() {
    let ur5 = robot("ur5"); // 150, 150, 150, 28, 28, 28 N m
    let ask =
        || mozzi_sim::torque(|t, _, _, tau| (0..6).for_each(|j| tau[j] = if j == 1 { 400.0 * t } else { -20.0 * t }));
    for (policy, given, overloads) in
        [(Policy::Ignore, 800.0, 0), (Policy::Report, 800.0, 4), (Policy::Respect, 150.0, 4)]
    {
        let mut motors = Saturated::new(&ur5, ask(), policy);
        for t in [0.1, 0.5, 2.0, 1.0] {
            torque(&mut motors, t, &[0.0; 6], &[0.0; 6]);
        }
        let tau = torque(&mut motors, 2.0, &[0.0; 6], &[0.0; 6]);
        assert_eq!((tau[1], tau[0], tau[5]), (given, -40.0, if policy == Policy::Respect { -28.0 } else { -40.0 }));
        let noted: Vec<_> = motors.overloads().collect();
        assert_eq!(noted.len(), overloads);
        if let Some(first) = noted.first() {
            let expected = ("shoulder_lift_joint", 800.0, 150.0, 0.5, 2.0);
            assert_eq!((first.joint.as_str(), first.largest, first.limit, first.first, first.last), expected);
        }
    }
    // a call at an earlier time replaces the demands of the last call
    let mut motors = Saturated::new(&ur5, ask(), Policy::Report).of_steps();
    for t in [0.5, 2.0, 1.0] {
        torque(&mut motors, t, &[0.0; 6], &[0.0; 6]);
    }
    let noted: Vec<_> = motors.overloads().map(|of| (of.joint.as_str(), of.largest, of.first, of.last)).collect();
    assert_eq!(noted, [("shoulder_lift_joint", 400.0, 0.5, 1.0)]);
    // the input's wrenches are passed on
    let tip = ur5.end_effector().expect("named");
    let mut wrenches = Vec::new();
    let mut pushing = Saturated::new(&ur5, applied(tip, |_, _, _| wrench(1)), Policy::Respect);
    pushing.applied(0.0, &[0.0; 6], &[0.0; 6], &mut wrenches).expect("fine");
    assert_eq!(wrenches, [(tip, wrench(1))]);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let (ur5, hold) = (robot("ur5"), || Hold::new(&[0.0; 6], 6));
    let words = |found: Option<crate::Error>, words: &str| {
        let text = found.expect("refused").to_string();
        assert!(text.contains(words), "{text}");
    };
    words(PdGravity::new(&ur5, hold(), Gains::uniform(5, 1.0, 1.0)).err(), "K_p has 5 entries, expected 6");
    words(ComputedTorque::new(&ur5, hold(), Gains::uniform(6, 1.0, -1.0)).err(), "K_d is [-1.0");
    let free = ur5.with_base(mozzi::Base::Floating).expect("sound");
    words(ComputedTorque::new(&free, hold(), Gains::uniform(12, 1.0, 1.0)).err(), "free");
    let law = Law::Acceleration { p: [f64::NAN; 6], d: [1.0; 6] };
    let tip = ur5.end_effector().expect("named");
    words(TaskSpace::new(&ur5, hold(), tip, law, Gains::uniform(6, 1.0, 1.0)).err(), "the task's K_p");
    let bars = mozzi::testing::four_bar();
    let foot = ContactPoint::new("foot", bars.frame("coupler").expect("a link"), Vec3::zero(), 0.7);
    let stands =
        Standing::new(&bars, Hold::new(&[0.0; 3], 3), Gains::uniform(3, 1.0, 1.0), vec![foot], SE3::identity());
    words(stands.err(), "a robot on standing feet is with 5 constraint rows, expected a robot without constraints");
    // a reference of another robot
    let mut control = PdGravity::new(&ur5, Hold::new(&[0.0; 7], 7), Gains::uniform(6, 1.0, 1.0)).expect("fine");
    let error = control.torque(0.0, &[0.0; 6], &[0.0; 6], &mut [0.0; 6]).expect_err("seven");
    assert!(error.to_string().contains("7 entries, expected 6"), "{error}");
}

#[test]
fn a_motor_moves_a_loop_to_its_goal() {
    let mut description = mozzi::testing::four_bar().description().clone();
    description.motors = Some(vec!["crank_pivot".to_string()]);
    let model = description.build().expect("sound");
    let closed = |crank: f64| model.assemble(&[crank, -0.6, 1.6], &["crank_pivot"]).expect("closes");
    let (start, goal) = (closed(1.0), closed(1.4));
    let omega = 8.0;
    let gains = Gains::critical(3, omega);
    let control = ComputedTorque::new(&model, Hold::new(&goal, 3), gains).expect("fine");
    let options = Options::new(2.0, 2000);
    let moved = mozzi_sim::simulate(&model, &start, &[0.0; 3], control, &options).expect("a motion");
    // only the crank has a motor
    for row in moved.samples() {
        assert!(row.tau[1].abs() < 1e-9 && row.tau[2].abs() < 1e-9, "{:?}", row.tau);
    }
    let e = |theta: &[f64]| goal.iter().zip(theta).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(e(moved.last().theta) < 1e-4 && e(&start) > 0.1, "{}", e(moved.last().theta));
    let gains = Gains { p: vec![40.0; 3], d: vec![6.0; 3] };
    let mut control = PdGravity::new(&model, Hold::new(&goal, 3), gains).expect("fine");
    let (mut stiffness, mut damping) = ([0.0; 3], [0.0; 3]);
    control.gains(&mut stiffness, &mut damping);
    assert_eq!((stiffness, damping), ([40.0, 0.0, 0.0], [6.0, 0.0, 0.0]));
    let settled =
        mozzi_sim::simulate(&model, &start, &[0.0; 3], &mut control, &Options::new(4.0, 4000)).expect("a motion");
    assert!(e(settled.last().theta) < 1e-3, "{:?} {goal:?}", settled.last().theta);
}
