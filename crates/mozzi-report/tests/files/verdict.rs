//! The headline, and units of numbers that enter it.

use crate::{compare_description, flat, has_cause, of_text, robot};
use mozzi_report::compare::files::{RobotFile, compare_files};

#[test]
fn robots_without_a_joint_in_common() {
    let arm = |name: &str, joint: &str, axis: &str| {
        let text = format!(
            "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='1'/><origin xyz='0.1 0 0'/>\
             <inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
             <joint name='{joint}' type='continuous'><parent link='base'/><child link='a'/><axis xyz='{axis}'/></joint></robot>"
        );
        of_text(name, &text)
    };
    let (a, b) = (arm("a.urdf", "hip", "0 1 0"), arm("b.urdf", "wheel", "1 0 0"));
    let comparison = compare_files(&a, &b, 10, 1, 1e-9).unwrap();
    let text = flat(&comparison);
    assert!(text.contains("a.urdf and b.urdf: no joint in common: nothing was compared"), "{text}");
    assert!(text.contains("moves in a.urdf only, and is held at 0: `hip`") && !text.contains("agree"), "{text}");
    assert!(!comparison.agrees() && !comparison.forces_agree() && !comparison.is_explained(), "{text}");
    assert_eq!(comparison.json()["compared"], false);
    // of floating robots the bases are
    let free = |file: &RobotFile| RobotFile {
        model: file.model.description().clone().floating().build().unwrap(),
        ..file.clone()
    };
    let comparison = compare_files(&free(&a), &free(&b), 10, 1, 1e-9).unwrap();
    let text = flat(&comparison);
    assert!(text.contains("no joint in common; only the floating bases are compared"), "{text}");
    assert!(!comparison.agrees() && comparison.is_compared(), "{text}");
    // one joint in common: agreement is that of this joint
    let comparison = compare_description(|robot| {
        let grip = robot.joints.iter_mut().find(|joint| joint.name == "grip").unwrap();
        (grip.kind, grip.mimic) = (mozzi::model::description::JointKind::Fixed, None);
    });
    let text = flat(&comparison);
    assert!(text.contains("before.urdf and b.urdf: another robot: one joint moves in one file only"), "{text}");
    assert!(text.contains("M, gravity torques and torques of the joints in both agree"), "{text}");
    assert!(!comparison.agrees(), "{text}");
}

#[test]
fn the_headline_names_what_differs() {
    let comparison = compare_description(|robot| robot.joints[0].limits.velocity = None);
    let text = flat(&comparison);
    assert!(text.starts_with("before.urdf and b.urdf: the same masses and geometry; limits differ"), "{text}");
    assert!(!comparison.agrees() && comparison.is_explained(), "{text}");
    let comparison = compare_description(|robot| {
        robot.joints[0].damping = 0.0;
        robot.joints[1].limits.effort = Some(7.0);
    });
    let text = flat(&comparison);
    assert!(text.contains(": the same masses and geometry; limits and damping differ"), "{text}");
    let comparison = compare_description(|robot| robot.joints[0].armature = 0.0);
    assert!(flat(&comparison).contains(": another robot; the causes below explain it"), "{}", comparison.text());
    // all is accounted for, but why the armature is another is not known
    let comparison = compare_description(|robot| robot.joints[0].armature *= 1.7);
    let text = flat(&comparison);
    let known = ": another robot; the causes below account for it, not all with a known reason";
    assert!(text.contains(known) && text.contains("the forces agree to"), "{text}");
    let json = comparison.json();
    assert_eq!([&json["explained"], &json["accounted_for"]], [false, true], "{text}");
}

#[test]
fn friction_has_no_angle() {
    let degree = std::f64::consts::PI / 180.0;
    has_cause(
        &compare_description(|robot| robot.joints[0].friction *= degree),
        "friction of `shoulder` differs in b.urdf: 0.00174533 instead of 0.1",
        false,
    );
    has_cause(
        &compare_description(|robot| robot.joints[0].damping *= degree),
        "damping of `shoulder` is per degree, not per radian in b.urdf",
        true,
    );
    has_cause(
        &compare_description(|robot| robot.joints[0].damping /= degree),
        "damping of `shoulder` is converted as if it were per degree in b.urdf",
        true,
    );
    let agrees = compare_files(&robot("before.urdf"), &robot("before.urdf"), 3, 1, 1e-9).unwrap();
    assert!(flat(&agrees).contains(": the same robot"));
}
