//! Gravity compensation, actuators, and forces of light joints.

use crate::{compare_description, flat, has_cause, of_text};
use mozzi_report::compare::files::{FilesComparison, RobotFile, compare_files};

fn arm(name: &str, gravcomp: &str, motor: &str) -> RobotFile {
    let text = format!(
        "<mujoco model='m'><worldbody><body name='arm' {gravcomp}><joint name='j' axis='0 1 0'/>\
         <inertial pos='0.2 0.1 0' mass='2' diaginertia='0.01 0.02 0.03'/></body></worldbody>\
         <actuator>{motor}</actuator></mujoco>"
    );
    of_text(name, &text)
}

fn compare(a: &RobotFile, b: &RobotFile) -> FilesComparison {
    compare_files(a, b, 5, 1, 1e-9).unwrap()
}

#[test]
fn gravity_compensation_is_a_difference_and_actuators_are_a_note() {
    let motor = "<motor name='m' joint='j'/>";
    let (with, without) = (arm("a.xml", "gravcomp='1'", motor), arm("b.xml", "", motor));
    has_cause(&compare(&with, &without), "gravity compensation of `arm` is 0 in b.xml, 1 here", true);
    let lost = compare(&without, &arm("c.xml", "", ""));
    assert!(lost.agrees() && flat(&lost).contains("note: actuator of b.xml only: `m`"), "{}", lost.text());
    // a format without either
    let other = RobotFile { name: "d.urdf".into(), actuation: None, ..arm("", "", "") };
    let unheld = compare(&with, &other);
    assert!(unheld.agrees() && flat(&unheld).contains("gravity compensation of `arm` is 0"), "{}", unheld.text());
}

#[test]
fn a_light_joint_is_compared_with_its_own_forces() {
    let heavy = |tolerance: f64| {
        let comparison = compare_description(|robot| {
            let finger = robot.links.iter_mut().find(|link| link.name == "finger").unwrap();
            finger.inertia = finger.inertia * 1.5;
        });
        let part = comparison.json()["differences"]["gravity_forces"]["part"].as_f64().unwrap();
        assert!(part > tolerance, "{}", comparison.text());
        flat(&comparison)
    };
    // half of its own forces, a hundredth of the shoulder's
    assert!(heavy(0.3).contains("gravity torque of `grip` differs by up to 0."), "{}", heavy(0.3));
}
