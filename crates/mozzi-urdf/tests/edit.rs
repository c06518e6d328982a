//! A URDF's text is edited in place: lines that do not change stay as they are.

use mozzi::{Description, Model, SpatialInertia, Vec3};
use mozzi_urdf::{drives_of_fixed_joints, edit, edit_with_old_values, parse};

const ARM: &str = include_str!("convert/arm.urdf");

fn arm() -> Model {
    parse("arm.urdf", ARM).expect("sound").build().expect("sound")
}

/// The edited text, and the lines that it has and the original lacks, and the reverse.
fn edited(text: &str, robot: &Description) -> (String, Vec<String>, Vec<String>) {
    let result = edit("arm.urdf", text, robot).expect("edited");
    let lacking =
        |a: &str, b: &str| a.lines().filter(|line| !b.lines().any(|l| l == *line)).map(str::to_string).collect();
    let (new, old) = (lacking(&result, text), lacking(text, &result));
    (result, new, old)
}

/// The text describes the robot, up to rounding.
fn assert_describes(text: &str, robot: &Model, theta: &[f64]) {
    let again = parse("again.urdf", text).expect("sound").build().expect("sound");
    assert!(again.joint_names().eq(robot.joint_names()) && again.base() == robot.base());
    let zero = vec![0.0; robot.n()];
    let (M, N) = (robot.mass_matrix(theta).expect("M"), again.mass_matrix(theta).expect("M"));
    assert!((M.clone() - N).amax() < 1e-14 * M.amax());
    let [g, h] = [robot, &again].map(|model| model.bias_forces(theta, &zero, &model.environment()).expect("h"));
    assert!((g.clone() - h).amax() <= 1e-14 * g.amax().max(1.0));
}

#[test]
fn without_edits_the_text_is_the_same() {
    for text in [ARM.to_string(), format!("\u{feff}{ARM}"), ARM.replace('\n', "\r\n")] {
        assert_eq!(edit("arm.urdf", &text, arm().description()).expect("edited"), text);
    }
}

#[test]
fn a_payload_changes_numbers_of_one_inertial() {
    let payload = SpatialInertia::point_mass(0.5, Vec3([0.0, 0.1, 0.0]));
    let robot = arm().with_payload(arm().frame("upper").expect("a link"), payload).expect("sound");
    let (text, new, old) = edited(ARM, robot.description());
    assert_eq!((new.len(), old.len()), (3, 3), "origin, mass and inertia: {new:?}");
    assert!(new[0].starts_with("      <origin rpy=\"0 0 1.5707963267948966\" xyz=\"0.083"), "{new:?}");
    assert_eq!(new[1], "      <mass value=\"3.0\"/>");
    assert_describes(&text, &robot, &[0.3, -0.4]);
    // a link without mass gets an element
    let robot = arm().with_payload(arm().frame("finger").expect("a link"), payload).expect("sound");
    let (text, new, old) = edited(ARM, robot.description());
    assert_eq!(old, ["  <link name=\"finger\"/>"]);
    assert_eq!((new[0].as_str(), new.len()), ("  <link name=\"finger\">", 2), "{new:?}");
    assert_describes(&text, &robot, &[0.3, -0.4]);
}

#[test]
fn an_inertia_that_is_repaired_is_rewritten_alone() {
    let text =
        ARM.replace("ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\"", "ixx=\"-0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\"");
    assert!(parse("arm.urdf", &text).is_err());
    let robot = mozzi_urdf::parse_with("arm.urdf", &text, mozzi_urdf::Policy::Lenient).expect("repaired").description;
    let (result, new, old) = edited(&text, &robot);
    assert!(new.len() == 1 && old.len() == 1 && old[0].contains("ixx=\"-0.01\""), "{new:?}");
    assert_describes(&result, &robot.build().expect("sound"), &[0.3, -0.4]);
}

#[test]
fn a_locked_joint_is_fixed_with_its_mimic_joints() {
    let robot = arm().with_locked_joints(&[("elbow", 0.5)]).expect("a joint");
    let (text, new, old) = edited(ARM, robot.description());
    assert_eq!(old.len(), 4, "two types, an origin, a mimic: {old:?}");
    assert_eq!(new[0], "  <joint name=\"elbow\" type=\"fixed\">");
    assert!(new[1].starts_with("    <origin xyz=\"0.2 0 0\" rpy=\"0.0 0.5"), "{new:?}");
    assert_eq!(new[3], "    <origin xyz=\"0.25 0.0 0.0\"/>", "{new:?}");
    assert!(!text.contains("<mimic"));
    assert_describes(&text, &robot, &[0.3]);
    // an attribute that is missing is added after the others
    let plain = ARM.replace(" rpy=\"0.0 0 0\"", "");
    let (text, new, _) = edited(&plain, robot.description());
    assert!(new[1].starts_with("    <origin xyz=\"0.2 0 0\" rpy=\"0.0 0.5"), "{new:?}");
    assert_describes(&text, &robot, &[0.3]);
}

#[test]
fn drives_of_a_locked_joint_are_named() {
    let drives = "<transmission name=\"t1\"><joint name=\"elbow\"/><actuator name=\"m\"/></transmission>\n\
                  <transmission name=\"t2\"><joint name=\"shoulder\"/></transmission>\n\
                  <ros2_control name=\"rc\" type=\"system\"><joint name=\"elbow\"/></ros2_control>\n</robot>";
    let text = ARM.replace("</robot>", drives);
    let robot = parse("arm.urdf", &text).expect("sound").build().expect("sound");
    assert!(drives_of_fixed_joints(&text, robot.description()).is_empty());
    let locked = robot.with_locked_joints(&[("elbow", 0.5)]).expect("a joint");
    let found = drives_of_fixed_joints(&edited(&text, locked.description()).0, locked.description());
    let of = |drive: &str| format!("{drive} drives joint `elbow`, which is fixed");
    assert_eq!(found, [of("<transmission> `t1`"), of("<ros2_control> `rc`")]);
}

#[test]
fn a_freed_base_adds_a_link_and_a_joint() {
    let robot: Model = arm().description().clone().floating().build().expect("sound");
    let (text, new, old) = edited(&ARM.replace('\n', "\r\n"), robot.description());
    assert!(old.is_empty() && new.len() == 2, "{new:?}");
    assert!(text.ends_with("</joint>\r\n</robot>\r\n"), "{text}");
    assert_describes(&text, &robot, &robot.neutral_configuration());
}

#[test]
fn other_differences_are_refused() {
    let refused = |change: &dyn Fn(&mut Description)| {
        let mut robot = arm().description().clone();
        change(&mut robot);
        edit("arm.urdf", ARM, &robot).expect_err("not edited").to_string()
    };
    assert!(
        refused(&|robot| robot.joints[1].limits.effort = Some(3.0)).contains("joint `elbow` differs in other things")
    );
    assert!(refused(&|robot| robot.links[1].name = "x".into()).contains("its links are others"));
    assert!(refused(&|robot| robot.gravity = [0.0; 3]).contains("gravity"));
}

#[test]
fn friction_and_armature_are_attributes_of_dynamics() {
    let mut robot = arm().description().clone();
    for joint in &mut robot.joints {
        (joint.damping, joint.friction, joint.armature) = (0.5, 1.25, 0.02);
    }
    robot.links[1].inertia = robot.links[1].inertia.map(|x| 1.5 * x);
    let moving = |kind: &str| kind != "fixed";
    robot.joints.iter_mut().filter(|joint| !moving(joint.kind.name())).for_each(|joint| {
        (joint.damping, joint.friction, joint.armature) = (0.0, 0.0, 0.0);
    });
    let mimics: Vec<String> = robot.joints.iter().filter(|j| j.mimic.is_some()).map(|j| j.name.clone()).collect();
    let text = edit("arm.urdf", ARM, &robot).expect("edited");
    let again = parse("again.urdf", &text).expect("sound").description;
    for (found, expected) in again.joints.iter().zip(&robot.joints).filter(|(joint, _)| !mimics.contains(&joint.name)) {
        let of = |joint: &mozzi::model::description::Joint| [joint.damping, joint.friction, joint.armature];
        assert_eq!(of(found), of(expected), "{}", found.name);
    }
    let commented = edit_with_old_values("arm.urdf", ARM, &robot).expect("edited");
    assert!(commented.contains("<!-- before: mass ") && commented.contains("<!-- before: damping "), "{commented}");
    let again = parse("again.urdf", &commented).expect("sound").description;
    assert_eq!(again.links[1].inertia.mass, robot.links[1].inertia.mass);
}
