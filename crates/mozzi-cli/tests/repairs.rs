//! `mozzi check --fix` proposes, and `--apply` writes the least change.

use crate::common;

use common::{complaint, file, folder, mozzi, text};
use std::io::Write;
use std::process::{Command, Stdio};

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

/// Standard output and standard error for this standard input.
fn filtered(arguments: &[&str], input: &str) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mozzi"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program runs");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("an end");
    assert!(output.status.success(), "{output:?}");
    [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text")).into()
}

#[test]
fn a_pipe_gets_the_robot_with_other_numbers_alone() {
    let windows = format!("\u{feff}{}", ARM.replace('\n', "\r\n"));
    let (robot, said) = filtered(&["check", "--fix", "--apply", "-"], &windows);
    let repaired = windows.replace("izz=\"0.3\"", "izz=\"0.03\"");
    assert_eq!(robot, repaired.replace("lower=\"2\" upper=\"-1\"", "lower=\"-1\" upper=\"2\""));
    assert!(said.contains("[power_of_ten]") && said.contains("standard input: 2 proposals, applied"), "{said}");
    let (again, said) = filtered(&["check", "--fix", "--apply", "-"], &robot);
    assert!(again == robot && said.contains("standard input: 0 proposals\n"), "{said}");
}

#[test]
fn unread_shapes_and_warnings_without_a_proposal_are_counted() {
    let folder = folder("repairs_left");
    let given = "<box size=\"0.3 0.3 0.2\"/>";
    let sound = ARM.replace("izz=\"0.3\"", "izz=\"0.03\"").replace("lower=\"2\"", "lower=\"-2\"");
    let robot = sound.replace("upper=\"-1\"", "upper=\"1\"").replace(" velocity=\"3\"", "");
    let robot = file(&folder, "arm.urdf", &robot.replace(given, "<mesh filename=\"a.dae\"/>"));
    file(&folder, "a.dae", "<COLLADA/>");
    let said = String::from_utf8(mozzi(&["check", &robot, "--fix"]).stderr).expect("text");
    let shapes = "arm.urdf: the shapes of 1 link were not read: mesh a.dae: surfaces of `dae` files are not read";
    for note in [shapes, "arm.urdf: 1 warning of `mozzi check` has no proposal", "arm.urdf: 0 proposals"] {
        assert!(said.contains(note), "{said}");
    }
    let lines = text(&["check", &robot, "--fix", "--json"]);
    let code = |line| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["code"].clone();
    assert_eq!(lines.lines().map(code).collect::<Vec<_>>(), ["unread_shapes", "without_proposal"]);
    let (_, message) = complaint(&["check", &robot, "--fix", "--mesh-root", &robot]);
    assert!(message.contains("expected a folder"), "{message}");
}
