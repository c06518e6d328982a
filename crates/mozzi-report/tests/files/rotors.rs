//! Rotors that several joints turn.

use crate::{flat, has_cause, of_text};
use mozzi::model::description::{Gear, Rotor};
use mozzi_report::compare::files::{FilesComparison, RobotFile, compare_files};

/// Two joints, and their rotors of an inertia and two ratios.
fn arm(name: &str, joints: [&str; 2], rotors: &[(&str, f64, [f64; 2])]) -> RobotFile {
    let body = |name: &str, joint: &str, rest: &str| {
        format!(
            "<body name='{name}' pos='0.3 0 0'><joint name='{joint}' axis='0 1 0'/><geom size='0.1' mass='1'/>{rest}</body>"
        )
    };
    let tree = body("A", joints[0], &body("B", joints[1], ""));
    let mut file = of_text(name, &format!("<mujoco model='m'><worldbody>{tree}</worldbody></mujoco>"));
    let mut robot = file.model.description().clone();
    robot.rotors = (rotors.iter())
        .map(|(name, armature, ratios)| Rotor {
            name: name.to_string(),
            armature: *armature,
            gears: joints.iter().zip(ratios).map(|(j, &ratio)| Gear { joint: j.to_string(), ratio }).collect(),
        })
        .collect();
    file.model = robot.build().unwrap();
    file
}

const JOINTS: [&str; 2] = ["j", "k"];
const ROTOR: (&str, f64, [f64; 2]) = ("t", 0.3, [2.0, -1.0]);

fn compare(a: &[(&str, f64, [f64; 2])], b: &[(&str, f64, [f64; 2])]) -> FilesComparison {
    compare_files(&arm("a.xml", JOINTS, a), &arm("b.xml", JOINTS, b), 5, 1, 1e-9).unwrap()
}

#[test]
fn a_rotor_that_differs_is_a_cause() {
    let lost = "rotor `t` is dropped in b.xml: inertia 0.3, turned by 2 `j` and -1 `k`";
    has_cause(&compare(&[ROTOR], &[]), lost, true);
    has_cause(&compare(&[], &[ROTOR]), "rotor `t` appears in b.xml: inertia 0.3, turned by 2 `j` and -1 `k`", true);
    let heavier = ("t", 300.0, [2.0, -1.0]);
    has_cause(&compare(&[ROTOR], &[heavier]), "inertia of rotor `t` is off by a factor 1e3", true);
    let geared = ("t", 0.3, [2.0, 1.0]);
    has_cause(
        &compare(&[ROTOR], &[geared]),
        "rotor `t` is another in b.xml: inertia 0.3, turned by 2 `j` and 1 `k`",
        false,
    );
    // another rotor under the name of one that both have
    let comparison = compare(&[ROTOR], &[("u", ROTOR.1, ROTOR.2), ("t", 0.1, [1.0, 1.0])]);
    has_cause(&comparison, "rotor `t` appears in b.xml: inertia 0.1", true);
}

#[test]
fn rotors_that_act_alike_are_the_same() {
    // twice the rate and a quarter of the inertia, the other sense of rotation, and another name
    let comparison = compare(&[ROTOR], &[("motor", 0.075, [-4.0, 2.0])]);
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    // one that turns with one joint only is this joint's armature
    let mut other = arm("b.xml", JOINTS, &[]);
    let mut robot = other.model.description().clone();
    robot.joints.iter_mut().find(|joint| joint.name == "k").unwrap().armature = 0.3;
    other.model = robot.build().unwrap();
    let comparison = compare_files(&arm("a.xml", JOINTS, &[("t", 0.3, [0.0, 1.0])]), &other, 5, 1, 1e-9).unwrap();
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
}

#[test]
fn rotors_of_joints_under_other_names() {
    let [a, b] = [("a.xml", JOINTS), ("b.xml", ["hip", "knee"])].map(|(name, joints)| arm(name, joints, &[ROTOR]));
    let comparison = compare_files(&a, &b, 5, 1, 1e-9).unwrap();
    assert!(comparison.agrees() && flat(&comparison).contains("`j` is `hip` in b.xml"), "{}", comparison.text());
}
