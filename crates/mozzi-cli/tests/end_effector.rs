//! The end effector that nobody names.

use crate::common::{complaint, file, folder, json, text, words};
use std::path::Path;

/// A URDF of an arm with `ee_link` and `tool0` at one origin, and an optional further leaf.
fn two_ended_arm(folder: &Path, name: &str, rpy: &str, more: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>\
             </inertial></link>"
        )
    };
    let fixed = |name: &str, rpy: &str, x: &str| {
        format!(
            "<link name='{name}'/><joint name='to_{name}' type='fixed'><origin xyz='{x} 0 0' rpy='{rpy}'/>\
             <parent link='arm'/><child link='{name}'/></joint>"
        )
    };
    let text = format!(
        "<robot name='arm'>{}{}<joint name='shoulder' type='continuous'><axis xyz='0 0 1'/><parent link='base'/>\
         <child link='arm'/></joint>{}{}{more}</robot>",
        link("base"),
        link("arm"),
        fixed("ee_link", rpy, "0.5"),
        fixed("tool0", "0 0 0", "0.5")
    );
    file(folder, name, &text)
}

#[test]
fn frames_in_one_place_are_no_ambiguity() {
    let folder = folder("first_frames");
    let arm = two_ended_arm(&folder, "arm.urdf", "0 0 1.57", "");
    let page = text(&["info", &arm]);
    assert!(page.contains("end effector: tool0 (`ee_link` has the same origin)"), "{page}");
    assert_eq!(json(&["compute", &arm, "fk"])["frame"], "tool0");
    let other = "<link name='camera'/><joint name='to_camera' type='fixed'><origin xyz='0.1 0 0'/><parent link='arm'/>\
                 <child link='camera'/></joint>";
    let branched = two_ended_arm(&folder, "branched.urdf", "0 0 0", other);
    assert_eq!(json(&["compute", &branched, "fk"])["frame"], "tool0");
    let page = words(&text(&["info", "panda"]));
    let expected = "end effector: panda_hand_tcp (by its name; other ends: `panda_leftfinger`, `panda_rightfinger`)";
    assert!(page.contains(expected), "{page}");
    // two tools, and ends without a tool's name
    for name in ["left_tcp", "camera"] {
        let other = other.replace("camera", name);
        let text = std::fs::read_to_string(two_ended_arm(&folder, "ends.urdf", "0 0 0", &other)).expect("a file");
        let text = if name == "camera" { text.replace("tool0", "a").replace("ee_link", "b") } else { text };
        let (_, said) = complaint(&["compute", &file(&folder, "ends.urdf", &text), "fk"]);
        assert!(said.contains("the end effector must be named"), "{said}");
    }
    // of equal frames without the name of ROS, the first
    let text = std::fs::read_to_string(two_ended_arm(&folder, "equal.urdf", "0 0 0", "")).expect("a file");
    let equal = file(&folder, "equal.urdf", &text.replace("tool0", "flange"));
    assert_eq!(json(&["compute", &equal, "fk"])["frame"], "ee_link");
}
