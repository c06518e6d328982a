//! Drake's extensions of URDF, against the numbers of Drake 1.5x.
#![allow(clippy::unwrap_used)]

use mozzi::linalg::Mat3;
use mozzi::{Model, SO3, Vec3};
use mozzi_urdf::{Consequence, Loaded, Policy, parse, parse_with};

const BODY: &str = "<inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/>\
     <inertia ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01' ixz='0.02' iyz='0.03'/></inertial>";
const ENDS: &str = "<parent link='world'/><child link='b'/><origin xyz='0.1 0.2 0.3' rpy='0.1 0.2 0.3'/>";

/// A body on a joint.
fn text(joint: &str, more: &str) -> String {
    format!(
        "<robot name='r' xmlns:drake='http://drake.mit.edu'><link name='world'/><link name='b'>{BODY}</link>{joint}{more}</robot>"
    )
}

fn drake(kind: &str, inside: &str) -> String {
    text(&format!("<drake:joint name='j' type='{kind}'>{ENDS}{inside}</drake:joint>"), "")
}

fn read(text: &str) -> Loaded {
    parse("r.urdf", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A robot without a warning.
fn model(text: &str) -> Model {
    parse_with("r.urdf", text, Policy::Strict).unwrap_or_else(|error| panic!("{error}")).build().unwrap()
}

/// Compares M and the torques at rest of θ̈ with Drake's numbers, which have six digits.
fn compare(model: &Model, theta: &[f64], dtheta: &[f64], M: &[f64], tau: &[f64]) {
    let found = model.mass_matrix(theta).unwrap();
    let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(found.iter().zip(M).all(|(&a, &b)| close(a, b)), "{found} {M:?}");
    let torques = model.inverse_dynamics(theta, dtheta, &vec![0.0; dtheta.len()], &model.environment()).unwrap();
    assert!(torques.iter().zip(tau).all(|(&a, &b)| close(a, b)), "{torques} {tau:?}");
}

#[test]
fn a_screw_is_a_helical_joint() {
    let screw = "<axis xyz='0 0.6 0.8'/><drake:screw_thread_pitch value='0.05'/><dynamics damping='0.3'/><limit lower='-1' upper='2' effort='5' velocity='3'/>";
    let robot = model(&drake("screw", screw));
    compare(&robot, &[0.3], &[-0.5], &[0.281727], &[-0.987071]);
    let joint = robot.joints().next().unwrap();
    assert_eq!((joint.kind.name(), joint.limits.position), ("helical", Some([-1.0, 2.0])));
    model(&drake("screw", "<drake:screw_thread_pitch value='-0.05'/>"));
}

#[test]
fn a_universal_joint_is_two_hinges() {
    let robot = model(&drake("universal", "<dynamics damping='0.3'/>"));
    assert_eq!(robot.joint_names().collect::<Vec<_>>(), ["j.rx", "j.ry"]);
    compare(&robot, &[0.3, 0.7], &[-0.5, 0.6], &[0.316432, -0.080925, -0.080925, 0.4], &[2.145645, -5.237874]);
    let warned = read(&drake("universal", "<axis xyz='0 0 1'/>")).warnings;
    assert_eq!(warned[0].message(), "joint `j`: axis: is ignored: a universal joint turns about x, then y");
}

#[test]
fn a_planar_joint_has_three_dampings() {
    let robot = model(&drake("planar", "<axis xyz='0 0 1'/><dynamics damping='1 2 3'/>"));
    let M = [2.0, 0.0, -0.43478, 0.0, 2.0, -0.104719, -0.43478, -0.104719, 0.35];
    compare(&robot, &[0.3, 0.5, 0.7], &[-0.5, 0.05, 0.6], &M, &[-4.360194, 1.863166, 2.54685]);
    for damping in ["1", "1 2", "1 2 x", "1 2 -3"] {
        let text = drake("planar", &format!("<axis xyz='0 0 1'/><dynamics damping='{damping}'/>"));
        assert_eq!(parse("r.urdf", text).unwrap_err().errors().count(), 1, "{damping}");
    }
}

#[test]
fn a_ball_has_three_velocities_of_one_damping() {
    let robot = model(&drake("ball", "<dynamics damping='0.3'/>"));
    let R = SO3::from_rpy(0.3, 0.5, 0.7);
    let (w, v) = R.quaternion();
    // Drake's velocities are in the parent's axes
    let dtheta = R.inverse_mul(Vec3([-0.5, 0.05, 0.6]));
    let drake_M = [[0.408101, -0.075924, -0.008808], [-0.075924, 0.345759, -0.065896], [-0.008808, -0.065896, 0.35614]];
    let turned = R.inverse().matrix() * Mat3::from_rows(drake_M) * R.matrix();
    let rows = turned.rows();
    let tau = R.inverse_mul(Vec3([3.984134, -3.448467, 1.370222]));
    let theta = [w, v.0[0], v.0[1], v.0[2]];
    compare(&robot, &theta, &dtheta.0, rows.as_flattened(), &tau.0);
}

fn continuous(inside: &str, more: &str) -> String {
    text(&format!("<joint name='j' type='continuous'>{ENDS}<axis xyz='0 0 1'/>{inside}</joint>"), more)
}

fn transmission(kind: &str, joint: &str) -> String {
    format!(
        "<transmission name='t'><type>{kind}</type><joint name='{joint}'/><actuator name='m'><drake:rotor_inertia value='0.01'/>\
         <drake:gear_ratio value='-10'/></actuator></transmission>"
    )
}

#[test]
fn a_rotor_is_an_armature() {
    let simple = transmission("transmission_interface/SimpleTransmission", "j");
    compare(&model(&continuous("", &simple)), &[0.3], &[-0.5], &[1.35], &[0.929884]);
    // several add up
    let both = format!(
        "{simple}<transmission type='SimpleTransmission'><joint name='j'/><actuator name='n'><drake:rotor_inertia value='0.5'/></actuator></transmission>"
    );
    compare(&model(&continuous("", &both)), &[0.3], &[-0.5], &[1.85], &[0.929884]);
    let inside = "<actuator name='m'><drake:rotor_inertia value='0.01'/><drake:gear_ratio value='10'/></actuator>";
    compare(&model(&continuous(inside, "")), &[0.3], &[-0.5], &[1.35], &[0.929884]);
    let prefixed = continuous("", &simple).replace(" xmlns:drake='http://drake.mit.edu'", "");
    assert_eq!(read(&prefixed).description.joints[0].armature, 1.0);
}

#[test]
fn a_rotor_that_drake_does_not_have_is_named() {
    for (joint, more) in [
        ("", transmission("DifferentialTransmission", "j")),
        ("<limit effort='0' velocity='1'/>", transmission("SimpleTransmission", "j")),
    ] {
        let robot = read(&continuous(joint, &more));
        assert_eq!(robot.description.joints[0].armature, 0.0);
        assert_eq!(robot.warnings[0].consequence(), Consequence::Motion);
        assert!(robot.warnings[0].message().starts_with("transmission `t`: its rotor is ignored: "));
    }
    let fixed = text(&format!("<joint name='j' type='fixed'>{ENDS}</joint>"), &transmission("SimpleTransmission", "j"));
    assert!(read(&fixed).warnings[0].message().ends_with("is ignored: joint `j` has not one axis"));
    let unknown = parse("r.urdf", continuous("", &transmission("SimpleTransmission", "k"))).unwrap_err();
    assert!(unknown.to_string().contains("transmission `t`: joint: there is no joint `k`"), "{unknown}");
    let negative = continuous("<actuator><drake:rotor_inertia value='-1'/></actuator>", "");
    assert!(parse("r.urdf", negative).unwrap_err().to_string().contains("armature: is -1"));
}

#[test]
fn forces_are_named_and_come_first() {
    let more = "<drake:linear_bushing_rpy/><drake:linear_spring_damper/><drake:tendon_constraint/>\
         <our:thing xmlns:our='o'/><drake:collision_filter_group name='g'/><gazebo reference='b'><mu1>1</mu1><kinematic>true</kinematic></gazebo>\
         <gazebo><static>false</static></gazebo><mujoco><compiler boundmass='1'/><option gravity='0 0 -1'/></mujoco>";
    let inside = "<limit lower='1' upper='0' effort='1' velocity='1' drake:acceleration='3'/><actuator><drake:controller_gains p='1' d='2'/></actuator>";
    let text = continuous(inside, more).replace("continuous", "revolute");
    let robot = read(&text);
    let first = |name: &str| robot.warnings.iter().position(|warning| warning.message().contains(name)).expect(name);
    for name in [
        "linear_bushing_rpy",
        "linear_spring_damper",
        "tendon_constraint",
        "our:thing",
        "kinematic",
        "boundmass",
        "gravity",
        "controller_gains",
    ] {
        assert_eq!(robot.warnings[first(name)].consequence(), Consequence::Motion, "{name}");
        assert!(first(name) < 8);
    }
    assert_eq!((robot.warnings.len(), first("goes from 1 to 0")), (9, 8));
    assert_eq!(parse_with("r.urdf", &text, Policy::Strict).unwrap_err().errors().count(), 9);
}
