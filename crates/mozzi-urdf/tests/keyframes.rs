//! MuJoCo's keyframes and its start: names, numbers, and omitted values.
#![allow(clippy::unwrap_used)]

use mozzi::SE3;
use mozzi::model::State;
use mozzi_urdf::{Policy, parse_with};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// A free stone, an arm of a ball, a hinge with `ref`, and a mimic joint of the hinge.
fn model(compiler: &str, keys: &str) -> (mozzi::Model, Vec<String>) {
    let text = format!(
        "<mujoco><compiler {compiler}/><worldbody><body name='arm'><joint name='ball' type='ball'/><geom size='0.1'/>\
         <body name='hand'><joint name='hinge' ref='90'/><geom size='0.1'/><body name='finger'><joint name='follows' type='slide'/>\
         <geom size='0.1'/></body></body></body><body name='stone' pos='1 0 2' euler='0 0 90'><freejoint name='fall'/><geom size='0.1'/>\
         </body></worldbody><equality><joint joint1='follows' joint2='hinge' polycoef='0 2 0 0 0'/></equality>\
         <keyframe>{keys}</keyframe></mujoco>"
    );
    let robot = parse_with("a.xml", text, Policy::Default).unwrap_or_else(|error| panic!("{error}"));
    let said = robot.warnings.iter().map(|warning| warning.message().to_string()).collect();
    (robot.build().unwrap(), said)
}

fn close(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15)
}

#[test]
fn the_start_is_the_files_own_configuration() {
    let (model, said) = model("", "<key name='home'/>");
    assert!(said.is_empty(), "{said:?}");
    assert_eq!(model.state_names().collect::<Vec<_>>(), ["qpos0", "home"]);
    let State { time, theta, dtheta } = model.start();
    assert!(close(&theta[..5], &[1.0, 0.0, 0.0, 0.0, FRAC_PI_2]), "{theta:?}");
    assert!(close(&theta[5..], &[FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2, 1.0, 0.0, 2.0]), "{theta:?}");
    assert_eq!((time, dtheta), (0.0, vec![0.0; 10]));
    // a key without numbers is the start, too
    assert_eq!(model.state("home").unwrap(), model.start());
    let at = model.forward_kinematics(&theta, model.frame("hand").unwrap()).unwrap();
    assert!((at.inverse() * SE3::identity()).log().norm() < 1e-15);
}

#[test]
fn keys_are_states_in_mozzis_order_and_axes() {
    let qpos = "0 1 0 0  0.5  -2.1415926535897932  1 2 3 0 0 2 0";
    let keys = format!(
        "<key time='1.5' qpos='{qpos}' qvel='1 2 3 4 8 5 6 7 8 9 10'/><key name='key0'/><key ctrl='1' act='1' mpos='1' mquat='1'/>"
    );
    let (model, said) = model("angle='degree'", &keys);
    assert_eq!(said, ["key `key0'`: qpos: the quaternion of joint `fall` has the length 2, and is normalized"]);
    // the name of the first is taken by the second
    assert_eq!(model.state_names().collect::<Vec<_>>(), ["qpos0", "key0'", "key0", "key2"]);
    let State { time, theta, dtheta } = model.state("key0'").unwrap();
    assert_eq!(time, 1.5);
    assert_eq!(theta, [0.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 1.0, 2.0, 3.0]); // keys are in radians
    // half a turn about y: v of the world's axes is (−x, y, −z) in the body's
    assert!(close(&dtheta, &[1.0, 2.0, 3.0, 4.0, 8.0, 9.0, 10.0, -5.0, 6.0, -7.0]), "{dtheta:?}");
}

#[test]
fn numbers_of_mimic_joints_are_compared() {
    let with = |hinge: f64, follows: f64, qvel: &str| {
        let key = format!("<key name='k' qpos='1 0 0 0 {hinge} {follows} 0 0 0 1 0 0 0' {qvel}/>");
        model("angle='radian' eulerseq='xyz'", &key).1
    };
    // follows = 2 (hinge − ref)
    assert!(with(90.5, 1.0, "").is_empty());
    assert!(with(90.5, 1.0005, "").is_empty());
    assert_eq!(
        with(90.5, 2.0, ""),
        ["key `k`: qpos: number 6 is 2, but joint `follows` follows `hinge`, which takes it to 1"]
    );
    assert_eq!(
        with(90.5, 1.0, "qvel='0 0 0 3 5 0 0 0 0 0 0'"),
        ["key `k`: qvel: number 5 is 5, but joint `follows` follows `hinge`, which takes it to 6"]
    );
}

#[test]
fn what_stands_as_its_file_says_at_zero_has_no_start_of_its_own() {
    let text = |pos: &str| {
        format!(
            "<mujoco><worldbody><body {pos}><freejoint/><geom size='1'/><body><joint/><geom size='1'/></body></body></worldbody></mujoco>"
        )
    };
    let robot = parse_with("a.xml", text(""), Policy::Strict).unwrap().description;
    assert!(robot.states.is_empty() && robot.start.is_none());
    let robot = parse_with("a.xml", text("pos='0 0 1'"), Policy::Strict).unwrap().description;
    assert_eq!(robot.start.as_deref(), Some("qpos0"));
    assert_eq!(robot.states[0].base.unwrap().pose, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    // a key of this name does not become the start
    let text = text("pos='0 0 1'").replace("</mujoco>", "<keyframe><key name='qpos0' time='3'/></keyframe></mujoco>");
    let robot = parse_with("a.xml", text, Policy::Strict).unwrap().description;
    assert_eq!(robot.start.as_deref(), Some("qpos0'"));
    assert_eq!(robot.states.iter().map(|state| state.time).collect::<Vec<_>>(), [0.0, 3.0]);
}

#[test]
fn states_are_read_whatever_the_inertias_need() {
    let text = "<mujoco><worldbody><body pos='0 0 1'><freejoint/><inertial mass='1' pos='0 0 0' diaginertia='1 1 -0.1'/></body>\
                </worldbody><keyframe><key name='k'/></keyframe></mujoco>";
    let robot = parse_with("a.xml", text, Policy::Lenient).unwrap();
    assert_eq!(robot.build().unwrap().state_names().collect::<Vec<_>>(), ["qpos0", "k"]);
}

#[test]
fn a_quaternion_of_length_0_is_that_of_no_rotation() {
    let qpos = "0 0 0 0  0.5  -2.1415926535897932  1 2 3 0 0 0 0";
    let (model, said) = model("angle='degree'", &format!("<key name='still' qpos='{qpos}'/>"));
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said.iter().all(|line| line.ends_with("has the length 0, and is (1, 0, 0, 0) here")), "{said:?}");
    let State { theta, .. } = model.state("still").unwrap();
    assert_eq!((theta[0], theta[5]), (1.0, 1.0));
    let wrong = format!(
        "<mujoco>{}</mujoco>",
        "<worldbody><body><freejoint/><geom size='1'/></body></worldbody><keyframe><key qpos='0 0 0 1e200 1e200 0 0'/></keyframe>"
    );
    assert!(mozzi_urdf::parse("a.xml", wrong).unwrap_err().to_string().contains("has the length inf"));
}
