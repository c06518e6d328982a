//! Gradients against differences, and motions against their limits.

use super::objective::Objective;
use super::{Basis, Box3, ExciteOptions, Goal, MotionLimits, Sphere, excite};
use crate::columns::Columns;
use crate::compress::stacked;
use crate::{Choice, Sensor};
use core::f64::consts::TAU;
use mozzi::model::description::{Gear, JointKind, Rotor};
use mozzi::random::Random;
use mozzi::{BaseParameters, Model, ScrewAxis};

fn robot(name: &str) -> Model {
    mozzi_urdf::open(name).expect("embedded").description.build().expect("sound")
}

#[test]
fn the_gradient_is_that_of_differences() {
    for (name, choice_of_goal, is_rich) in [
        ("double_pendulum", Goal::LogDet, false),
        ("ur5", Goal::LogDet, false),
        ("double_pendulum", Goal::Condition, false),
        ("double_pendulum", Goal::LogDet, true),
    ] {
        let mut model = robot(name);
        if is_rich {
            let mut wrist = model.description().clone();
            let gear = |joint: &str, ratio: f64| Gear { joint: joint.into(), ratio };
            let gears = vec![gear(&wrist.joints[0].name, 2.0), gear(&wrist.joints[1].name, -1.5)];
            wrist.rotors.push(Rotor { name: "both".into(), armature: 0.1, gears });
            model = wrist.build().expect("sound");
        }
        let mut options = ExciteOptions { harmonics: 3, goal: choice_of_goal, ..ExciteOptions::new(&model, 6.0) };
        options.limits.velocity.fill(0.5);
        options.limits.torque.fill(10.0);
        let tip = model.frames().last().expect("a frame").0;
        let first = model.frames().next().expect("a frame").0;
        options.limits.boxes.push(Box3 { frame: tip, corners: [[-0.1, -0.1, 0.0], [0.2, 0.2, 0.3]] });
        let [a, b] = [first, tip].map(|frame| Sphere { frame, radius: 0.5 });
        options.limits.apart.push((a, b));
        if is_rich {
            (options.choice.stribeck, options.choice.stiffness, options.choice.payload) = (Some(0.2), true, Some(tip));
        }
        options.choice.apparent = false;
        let columns = Columns::new(&model, options.choice.clone()).expect("columns");
        let names = columns.unknowns.iter().map(|unknown| unknown.name.clone()).collect();
        let base = BaseParameters::of_columns(&stacked(&columns, 60).expect("rows"), names);
        let basis = Basis { duration: 6.0, harmonics: 3 };
        let mut objective = Objective::new(&columns, &base, &basis, &options).expect("an objective");
        let mut random = Random(2);
        let c = random.vector(model.n() * basis.count(), 0.4);
        let (_, gradient) = objective.value(&c, 3.0);
        let scale = gradient.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for k in 0..c.len() {
            let h = 1e-6;
            let mut at = |x: f64| {
                let mut c = c.clone();
                c[k] += x;
                objective.value(&c, 3.0).0
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            assert!((slope - gradient[k]).abs() < 2e-5 * scale, "{name} {k}: {slope} and {}", gradient[k]);
        }
    }
}

#[test]
fn the_motion_is_better_than_a_random_one_and_keeps_its_limits() {
    let model = robot("ur5");
    let mut options = ExciteOptions { iterations: 25, starts: 1, ..ExciteOptions::new(&model, 10.0) };
    options.choice = Choice::all(Sensor::Link);
    options.limits = MotionLimits { velocity: vec![1.5; 6], acceleration: vec![5.0; 6], ..options.limits };
    let found = excite(&model, &options, &|| false).expect("a motion");
    eprintln!("condition {:.1} instead of {:.1}", found.condition, found.condition_of_random);
    assert!(found.condition < 0.7 * found.condition_of_random);
    for k in 0..=1000 {
        let [theta, dtheta, ddtheta] = found.at(k as f64 / 100.0);
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
        for j in 0..6 {
            let [low, high] = options.limits.position[j];
            assert!(theta[j] >= low - 1e-3 && theta[j] <= high + 1e-3);
            assert!(
                dtheta[j].abs() < 1.51 && ddtheta[j].abs() < 5.05 && tau[j].abs() < 1.01 * options.limits.torque[j]
            );
        }
    }
    let rest = found.at(0.0);
    assert!(rest[1].iter().chain(&rest[2]).all(|x| x.abs() < 1e-9));
}

/// Boxes, spheres and torques, about a given start and about one that is found.
#[test]
fn boxes_distances_and_torques_hold_all_the_time() {
    let model = robot("ur5");
    let [tip, base] = ["tool0", "base_link"].map(|name| model.frame(name).expect("there"));
    let short = ExciteOptions { iterations: 10, starts: 1, harmonics: 2, ..ExciteOptions::new(&model, 6.0) };
    let excite = |start: Option<Vec<f64>>, change: &dyn Fn(&mut MotionLimits)| {
        let mut options = ExciteOptions { start, ..short.clone() };
        change(&mut options.limits);
        super::excite(&model, &options, &|| false).map(|found| (options.limits, found))
    };
    let corners = [[0.2, -0.2, 0.1], [0.7, 0.4, 0.5]];
    let within = |limits: &mut MotionLimits| limits.boxes.push(Box3 { frame: tip, corners });
    let apart = |limits: &mut MotionLimits| {
        let [a, b] = [(tip, 0.3), (base, 0.4)].map(|(frame, radius)| Sphere { frame, radius });
        limits.apart.push((a, b));
    };
    let weak = |limits: &mut MotionLimits| limits.torque = vec![150.0, 60.0, 40.0, 28.0, 28.0, 28.0];
    let inside = vec![0.0, -1.2, 1.5, 0.3, 1.1, 0.0];
    for (start, change) in
        [(Some(inside.clone()), &within as &dyn Fn(&mut MotionLimits)), (None, &within), (None, &apart), (None, &weak)]
    {
        let (limits, found) = excite(start.clone(), change).expect("a motion");
        for k in 0..=600 {
            let at = found.at(k as f64 / 100.0);
            let tau = model.inverse_dynamics(&at[0], &at[1], &at[2], &model.environment()).expect("lengths");
            let mut loose = limits.clone();
            loose.torque.iter_mut().for_each(|torque| *torque *= 1.01);
            loose.velocity.iter_mut().for_each(|velocity| *velocity *= 1.01);
            loose.acceleration.iter_mut().for_each(|acceleration| *acceleration *= 1.01);
            loose.position.iter_mut().for_each(|[low, high]| (*low, *high) = (*low - 1e-3, *high + 1e-3));
            for Box3 { corners: [low, high], .. } in &mut loose.boxes {
                low.iter_mut().for_each(|x| *x -= 1e-3);
                high.iter_mut().for_each(|x| *x += 1e-3);
            }
            loose.apart.iter_mut().for_each(|(a, _)| a.radius -= 1e-3);
            assert_eq!(loose.broken(&model, &at, tau.as_slice()).expect("frames"), None, "t = {k}/100 s");
        }
        let moves = found.coefficients.iter().map(|c| c.abs()).fold(0.0, f64::max);
        assert!(moves > 1e-2 && start.is_none_or(|start| found.at(0.0)[0] == start), "{moves}");
    }
    // what no motion can keep is named
    let error = |start: Option<Vec<f64>>, change: &dyn Fn(&mut MotionLimits)| {
        excite(start, change).expect_err("impossible").to_string()
    };
    let far = |limits: &mut MotionLimits| {
        limits.boxes.push(Box3 { frame: tip, corners: [[2.0; 3], [3.0; 3]] });
    };
    let message = error(None, &far);
    assert!(message.contains("`tool0` at (") && message.contains("outside its box by"), "{message}");
    let stretched = || Some(vec![0.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
    let message = error(stretched(), &|limits| limits.torque = vec![150.0, 20.0, 20.0, 28.0, 28.0, 28.0]);
    assert!(message.contains("the torque of `shoulder_lift_joint` of") && message.contains("20.0000"), "{message}");
    let message = error(stretched(), &within);
    assert!(message.contains("the start is `tool0`"), "{message}");
    let message = error(Some(inside), &|limits| limits.velocity[2] = 0.0);
    assert!(message.contains("a limit of velocity is 0 for `elbow_joint`"), "{message}");
}

#[test]
fn wrong_options_are_named() {
    let model = robot("double_pendulum");
    let options = ExciteOptions::new(&model, 10.0);
    let error = |options: ExciteOptions| excite(&model, &options, &|| false).expect_err("wrong").to_string();
    assert!(error(ExciteOptions { duration: -1.0, ..options.clone() }).contains("the duration is -1 s"));
    for rate in [0.0, -5.0, f64::INFINITY] {
        assert!(error(ExciteOptions { rate, ..options.clone() }).contains("the rate is "));
    }
    let frame = model.frame(model.description().links[1].name.as_str()).expect("a link");
    let mut apart = options.clone();
    apart.limits.apart = vec![(Sphere { frame, radius: 0.1 }, Sphere { frame, radius: -1.0 })];
    assert!(error(apart).contains("a radius is -1 m"));
    let mut still = options.clone();
    still.limits.position = vec![[0.0, 0.0]; 2];
    assert!(error(still).contains("the range of every joint is 0"));
    assert!(error(ExciteOptions { harmonics: 0, ..options.clone() }).contains("harmonics is 0"));
    assert!(error(ExciteOptions { start: Some(vec![0.0]), ..options.clone() }).contains("the start is [0.0]"));
    assert!(error(ExciteOptions { noise: vec![0.0, 1.0], ..options }).contains("the noise"));
}

#[test]
fn a_joint_that_stays_has_no_condition_number() {
    let model = robot("double_pendulum");
    let mut options = ExciteOptions::new(&model, 2.0);
    (options.starts, options.iterations) = (1, 1);
    options.limits.position[1] = [0.3, 0.3];
    assert_eq!(excite(&model, &options, &|| false).expect("a motion").condition, f64::INFINITY);
}

#[test]
fn limits_are_within_those_of_the_file() {
    let mut pendulum = mozzi_urdf::open("double_pendulum").expect("embedded").description;
    for (limits, expected) in [
        ([7.0, 9.0], [7.04, 8.96]),
        ([100.0, 200.0], [100.0 + 0.04 * TAU, 100.0 + 1.96 * TAU]),
        ([-1e3, 1e3], [-0.96 * TAU, 0.96 * TAU]),
        ([1.0, f64::MAX], [1.0 + 0.02 * TAU, 1.0 + 0.98 * TAU]),
    ] {
        pendulum.joints[0].limits.position = Some(limits);
        let found = MotionLimits::of(&pendulum.clone().build().expect("sound")).position[0];
        assert!((0..2).all(|end| (found[end] - expected[end]).abs() < 1e-9), "{limits:?}: {found:?}");
    }
    pendulum.joints[0].limits.position = Some([7.0, 9.0]);
    pendulum.joints[0].kind = JointKind::Screw(ScrewAxis::new([0.0; 3], [1.0, 0.0, 0.0]).expect("unit"));
    assert_eq!(MotionLimits::of(&pendulum.build().expect("sound")).position[0], [7.04, 8.96]);
}
