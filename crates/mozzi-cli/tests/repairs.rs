//! `mozzi check --fix` proposes, and `--apply` writes the least change.

use crate::common;

use common::{complaint, file, folder, mozzi, text};

const ARM: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial><origin xyz="0 0 0.1"/><mass value="2"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.3"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.3 0.3 0.2"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="2" upper="-1" effort="9" velocity="3"/></joint>
</robot>
"#;

#[test]
fn a_repair_is_proposed_and_then_applied() {
    let folder = folder("repairs");
    let robot = file(&folder, "arm.urdf", ARM);
    let said = text(&["check", &robot, "--fix"]);
    assert!(said.contains("arm.urdf:3: link `upper`: izz 0.3 → 0.03 [power_of_ten]\n  because "), "{said}");
    assert!(said.contains("\n  M: entry (1, 1) 0.3 → 0.03 at the robot's start"), "{said}");
    assert!(said.contains("arm.urdf:8: joint `shoulder`: lower 2 → -1, upper -1 → 2 [reversed_limit]"), "{said}");
    assert_eq!(std::fs::read_to_string(&robot).expect("the robot"), ARM, "nothing is changed unasked");
    let lines = text(&["check", &robot, "--fix", "--json"]);
    let first: serde_json::Value = serde_json::from_str(lines.lines().next().expect("a line")).expect("JSON");
    assert_eq!((&first["code"], &first["line"]), (&"power_of_ten".into(), &3.into()), "{first}");

    let output = mozzi(&["check", &robot, "--fix", "--apply"]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stderr).contains("2 proposals, applied"));
    let repaired =
        ARM.replace("izz=\"0.3\"", "izz=\"0.03\"").replace("lower=\"2\" upper=\"-1\"", "lower=\"-1\" upper=\"2\"");
    assert_eq!(std::fs::read_to_string(&robot).expect("the robot"), repaired);
    assert!(text(&["check", &robot, "--fix"]).is_empty());

    let said = text(&["check", &robot, "--estimate-inertia", "density=500"]);
    assert!(said.contains("[estimated_inertia]") && said.contains("filled evenly with the given mass"), "{said}");
    for (flags, word) in [
        (&["--apply"][..], "--fix"),
        (&["--estimate-inertia", "1000"], "density="),
        (&["--fix", "--format", "sarif"], "text or JSON"),
    ] {
        let (_, message) = complaint(&[&["check", &robot], flags].concat());
        assert!(message.contains(word), "{flags:?}: {message}");
    }
}
