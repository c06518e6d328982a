//! Rotors that several joints turn, and the armature of free joints.

use super::{close, column};
use crate::model::description::{Gear, Joint, JointKind, Rotor};
use crate::spatial::{ScrewAxis, SpatialInertia};
use crate::testing::{state, tree};
use crate::{Description, Model, SE3, Vec3};
use alloc::vec;

fn rotor(armature: f64, gears: &[(&str, f64)]) -> Rotor {
    let gear = |&(joint, ratio): &(&str, f64)| Gear { joint: joint.into(), ratio };
    Rotor { name: "differential".into(), armature, gears: gears.iter().map(gear).collect() }
}

/// Two masses on parallel slides.
fn slides() -> Description {
    let slide = JointKind::Screw(ScrewAxis::new([0.0; 3], [0.0, 0.0, 1.0]).expect("unit"));
    Description::new("slides")
        .with_gravity([0.0; 3])
        .link("base", SpatialInertia::zero())
        .link("a", SpatialInertia::point_mass(2.0, Vec3::zero()))
        .link("b", SpatialInertia::point_mass(3.0, Vec3::zero()))
        .joint(Joint::new("left", "base", "a", SE3::identity(), slide))
        .joint(Joint::new("right", "base", "b", SE3::identity(), slide))
}

#[test]
fn a_differential_couples_joints_that_share_no_link() {
    let mut robot = slides();
    robot.rotors.push(rotor(0.5, &[("left", 2.0), ("right", -3.0)]));
    let model = robot.build().expect("sound");
    let M = model.mass_matrix(&[0.1, 0.2]).expect("lengths");
    assert_eq!(M.as_slice(), [2.0 + 0.5 * 4.0, -0.5 * 6.0, -0.5 * 6.0, 3.0 + 0.5 * 9.0]);
    assert!(model.couples(0, 1) && model.solves_by_mass_matrix() && !model.has_mimic_joints());
    // 2 N on the left one: the rotor takes the right one along
    let a = model.forward_dynamics(&[0.1, 0.2], &[0.0; 2], &[2.0, 0.0], &model.environment()).expect("regular");
    let det = 4.0 * 7.5 - 9.0;
    assert!((a[0] - 15.0 / det).abs() < 1e-15 && (a[1] - 6.0 / det).abs() < 1e-15, "{a}");
    let energy = model.kinetic_energy(&[0.1, 0.2], &[0.7, 0.3]).expect("lengths");
    let rate = 2.0 * 0.7 - 3.0 * 0.3;
    assert!((energy - 0.5 * (2.0 * 0.49 + 3.0 * 0.09 + 0.5 * rate * rate)).abs() < 1e-15);
    // a joint that is held does not turn it
    let held = model.with_locked_joints(&[("right", 0.4)]).expect("a joint");
    assert_eq!(held.mass_matrix(&[0.1]).expect("lengths").as_slice(), [4.0]);
}

#[test]
fn forward_dynamics_undoes_inverse_dynamics_with_rotors_alone() {
    let mut robot = tree(4, 8, 0).description().clone();
    robot.rotors.push(rotor(0.7, &[("joint2", 1.0), ("joint5", -0.5), ("joint8", 2.0)]));
    for base in [crate::Base::Fixed, crate::Base::Floating] {
        robot.base = base;
        let model = robot.clone().build().expect("sound");
        let [theta, dtheta, ddtheta] = state(&model, 3);
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
        let again = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &model.environment()).expect("regular");
        close(&column(&again), &column(&nalgebra::DVector::from_column_slice(&ddtheta)), 0.0, 1e6, "θ̈");
    }
}

#[test]
fn the_armature_of_a_free_joint_is_a_mass_without_weight() {
    // against a body of more mass and inertia, the same in all directions, at the origin, without gravity
    let free = |armature: f64, more: f64| -> Model {
        let G = crate::testing::inertia(5);
        let body = G + SpatialInertia { mass: more, mc: Vec3::zero(), I: crate::Sym3::diagonal(more, more, more) };
        let joint = Joint { armature, ..Joint::new("free", "world", "body", SE3::identity(), JointKind::Free) };
        let robot = Description::new("free").with_gravity([0.0; 3]);
        robot.link("world", SpatialInertia::zero()).link("body", body).joint(joint).build().expect("sound")
    };
    let [ours, theirs] = [free(0.8, 0.0), free(0.0, 0.8)];
    let [theta, dtheta, ddtheta] = state(&ours, 2);
    let tau = |model: &Model| model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
    close(&column(&tau(&ours)), &column(&tau(&theirs)), 0.0, 30.0, "τ");
    let of = |model: &Model| model.forward_dynamics(&theta, &dtheta, &[0.3; 6], &model.environment()).expect("regular");
    close(&column(&of(&ours)), &column(&of(&theirs)), 0.0, 1e4, "θ̈");
}

#[test]
fn wrong_rotors_are_errors_by_name() {
    let message = |rotors: &[Rotor]| {
        let mut robot = slides();
        robot.rotors = rotors.to_vec();
        robot.build().expect_err("a wrong rotor").to_string()
    };
    for (rotors, expected) in [
        (
            vec![rotor(-1.0, &[("left", 1.0)])],
            "rotor `differential`: armature: is -1, expected a finite number, at least 0",
        ),
        (vec![rotor(1.0, &[])], "rotor `differential`: joints: are missing, expected those that turn it"),
        (vec![rotor(1.0, &[("up", 1.0)])], "joints: hold `up`, which does not exist, expected some of `left`, `right`"),
        (
            vec![rotor(1.0, &[("left", 1.0), ("left", 2.0)])],
            "joints: hold `left` twice, expected one ratio for each joint",
        ),
        (vec![rotor(1.0, &[("left", f64::NAN)])], "ratio: is NaN at `left`, expected a finite number"),
        (vec![rotor(1.0, &[("left", 1.0)]); 2], "name: `differential` is used twice"),
    ] {
        let found = message(&rotors);
        assert!(found.contains(expected), "{found}");
    }
    let mut robot = slides();
    robot.joints[1].kind = JointKind::Ball(Vec3::zero());
    robot.rotors.push(rotor(1.0, &[("left", 1.0), ("right", 1.0)]));
    let found = robot.build().expect_err("a ball").to_string();
    assert!(found.contains("joints: hold `right`, a ball joint, expected joints of one axis"), "{found}");
}
