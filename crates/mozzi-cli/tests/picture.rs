//! Pictures of a robot at one configuration.

use crate::common;

use common::{complaint, file, folder, json, mozzi, text};

/// Two links without shapes, and one with a mesh.
const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="hand">
    <inertial><origin xyz="0 0 0.2"/><mass value="1.5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="hand.stl" scale="0.1 0.1 0.1"/></geometry></visual>
    <visual><geometry><mesh filename="missing.stl"/></geometry></visual>
  </link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="hand"/><origin xyz="0 0 0.5"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>"#;

const TETRAHEDRON: &str = "solid t\n\
    facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n\
    facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n";

#[test]
fn a_robot_is_drawn_in_light_and_dark_from_each_side() {
    let folder = folder("picture");
    let out = folder.join("arm.svg").to_string_lossy().into_owned();
    let drawn = |arguments: &[&str]| {
        text(&[&["picture"], arguments, &["--out", &out]].concat());
        std::fs::read_to_string(&out).expect("a picture")
    };
    let state = ["ur5", "--theta", "0,-1.2,1.5,0.3,1.1,0"];
    let light = drawn(&state);
    assert!(light.contains("<title>ur5, 6 joints, 21.0 kg</title>") && light.contains("fill=\"#ffffff\""));
    assert_eq!((light.matches("data-body=").count(), light.matches("class=\"axis\"").count()), (7, 6));
    assert_eq!(
        drawn(&[
            "ur5",
            "--deg",
            "--theta",
            "0,-68.75493541569878,85.94366926962348,17.188733853924695,63.02535746439055,0"
        ]),
        light
    );
    assert!(drawn(&[&state[..], &["--dark"]].concat()).contains("fill=\"#15191f\""));
    let views = ["iso", "front", "side", "top"].map(|view| drawn(&[&state[..], &["--view", view]].concat()));
    assert!(views[0] == light && (1..4).all(|k| views[k] != views[k - 1]));
    let turned = drawn(&[&state[..], &["--azimuth", "-90deg", "--elevation=0"]].concat());
    assert_eq!(turned, views[2], "the side view by its angles");
    let plain = drawn(&[&state[..], &["--plain", "--frames", "--title", "A <b> & c"]].concat());
    assert!(
        !plain.contains("class=\"axis\"") && !plain.contains("class=\"mass\"") && plain.contains("A &lt;b&gt; &amp; c")
    );
    assert_eq!(plain.matches("class=\"frame\"").count(), 7, "six links and the tool");
    assert!(drawn(&["ur5", "--payload", "2"]).contains("23.0 kg"));
    assert!(drawn(&["ur5", "--lock", "elbow_joint=0.5"]).contains("ur5, 5 joints"));
    let found = json(&["picture", "anymal", "--bones", "--out", &out]);
    assert_eq!(
        (&found["bodies"], &found["bones"], &found["title"]),
        (&13.into(), &16.into(), &"anymal, 12 joints, 30.5 kg".into())
    );
}

#[test]
fn bodies_without_shapes_have_bones_and_missing_meshes_are_noted() {
    let folder = folder("picture_arm");
    let robot = file(&folder, "arm.urdf", ARM);
    file(&folder, "hand.stl", TETRAHEDRON);
    let out = folder.join("arm.svg").to_string_lossy().into_owned();
    let output = mozzi(&["picture", &robot, "--out", &out, "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("mesh missing.stl was not found"), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&found["bodies"], &found["bones"]), (&3.into(), &2.into()), "the hand has a shape");
    assert_eq!(found["title"], "arm, 2 joints, 3.50 kg");
    let found = json(&["picture", &robot, "--out", &out, "--meshes", "none"]);
    assert_eq!(found["bones"], 3);
}

#[test]
fn wrong_outputs_are_refused() {
    let folder = folder("picture_wrong");
    let robot = file(&folder, "arm.urdf", ARM);
    for (arguments, expected) in [
        (vec!["picture", "ur5", "--out", "x.html"], "--out is x.html, expected a file that ends in .svg, .png or .pdf"),
        (vec!["picture", &robot, "--out", &robot], "--out is the file MODEL"),
        (vec!["picture", "ur5", "--out", "x.svg", "--theta", "1,2"], "--theta has 2 entries, expected 6"),
        (vec!["picture", "ur5", "--out", "x.svg", "--dtheta", "1,2,3,4,5,6"], "--dtheta has no effect"),
        (vec!["picture", "ur5", "--out", "x.svg", "--azimuth", "east"], "--azimuth is `east`, expected a number"),
    ] {
        let (code, said) = complaint(&arguments);
        assert!(code == 1 && said.contains(expected), "{arguments:?}: {said}");
    }
    assert!(std::fs::read_to_string(robot).expect("the robot").contains("<robot"));
}
