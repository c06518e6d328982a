//! `--constraints FILE`, and constraints in a robot's JSON.

use crate::common;

use common::{complaint, file, folder, json, mozzi, text};
use serde_json::Value;

const LOOPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/constraints/loops.xml");
const ROD: &str = "{\"constraints\": [{\"name\": \"rod\", \"kind\": \"distance\", \"length\": 0.5,\n \
                   \"a\": {\"frame\": null}, \"b\": {\"frame\": \"link2\"}}], \"motors\": [\"joint1\"]}";

/// The robot's JSON after a conversion.
fn converted(folder: &std::path::Path, arguments: &[&str]) -> (String, Value) {
    let out = file(folder, "out.json", "");
    text(&[&["convert"], arguments, &[&out]].concat());
    let found = std::fs::read_to_string(&out).expect("written");
    (out, serde_json::from_str(&found).expect("JSON"))
}

#[test]
fn json_keeps_constraints_and_motors() {
    let folder = folder("constraints-json");
    let (first, robot) = converted(&folder, &[LOOPS]);
    let names: Vec<&str> =
        robot["constraints"].as_array().expect("a list").iter().filter_map(|one| one["name"].as_str()).collect();
    assert_eq!(names, ["connect0", "grip", "cam", "stop"]);
    assert_eq!(robot["motors"], Value::Null);
    let copy = file(&folder, "copy.json", &std::fs::read_to_string(first).expect("written"));
    assert_eq!(converted(&folder, &[&copy]).1, robot);
    let wrong = robot.to_string().replace("\"weld\"", "\"wled\"");
    let (code, why) = complaint(&["info", &file(&folder, "wrong.json", &wrong)]);
    assert!(code != 0 && why.contains("constraints[1].kind is \"wled\", expected one of `point`, `weld`"), "{why}");
    let (_, why) = complaint(&["convert", &copy, &file(&folder, "out.urdf", "")]);
    assert!(why.contains("`cam`"), "{why}");
}

#[test]
fn a_file_adds_constraints_to_any_robot() {
    let folder = folder("constraints-file");
    let rod = file(&folder, "rod.json", ROD);
    let (_, robot) = converted(&folder, &["two_link_planar", "--constraints", &rod]);
    assert_eq!(robot["constraints"][0]["length"], 0.5);
    assert_eq!(robot["motors"][0], "joint1");
    let bad = file(&folder, "bad.json", &ROD.replace("link2", "lnik2"));
    for command in ["info", "check"] {
        let (code, why) = complaint(&[command, "two_link_planar", "--constraints", &bad]);
        assert!(
            code != 0 && why.contains("bad.json:1:18: constraint `rod`: b: there is no link or frame `lnik2`"),
            "{why}"
        );
    }
    // a robot.yaml next to the robot is mentioned, not read
    let (_, tree) = converted(&folder, &["two_link_planar"]);
    let robot = file(&folder, "robot.json", &tree.to_string());
    file(&folder, "robot.yaml", "closed_loop: []");
    let output = mozzi(&["info", &robot]);
    let notes = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && notes.contains("robot.yaml is not read; --constraints"), "{notes}");
}

#[test]
fn a_benchmark_has_the_quantities_of_the_robot() {
    let folder = folder("constraints-bench");
    let at_its_end = r#""link2", "xyz": [0.7, 0, 0]"#;
    let rod = file(&folder, "rod.json", &ROD.replace(r#""link2""#, at_its_end));
    let size = ["--states", "8", "--rounds", "1", "--threads", "1", "--all"];
    let timed = |arguments: &[&str]| {
        let found = json(&[&["bench", "two_link_planar"], arguments, &size].concat());
        let timings = found["timings"].as_array().expect("a list").clone();
        move |name: &str| timings.iter().any(|timing| timing["quantity"] == name)
    };
    let (free, held) = (timed(&[]), timed(&["--constraints", &rod]));
    assert!(free("inverse-dynamics") && free("inverse-dynamics-vjp") && !free("constraint-jacobian"));
    assert!(held("inverse-dynamics") && held("constraint-jacobian") && held("constrained-forward-dynamics"));
    let (code, why) = complaint(&[&["bench", "ur5", "--quantity", "constraint-jacobian"], &size[..]].concat());
    assert!(code != 0 && why.contains("ur5 has no constraints; --constraints FILE adds some"), "{why}");
}

#[test]
fn inverse_kinematics_and_identification_refuse_loops() {
    let folder = folder("constraints-refused");
    let robot = "<mujoco model=\"m\"><worldbody><body name=\"a\"><joint name=\"j1\" axis=\"0 1 0\"/>\
                 <geom type=\"capsule\" fromto=\"0 0 0 0 0 -0.5\" size=\"0.04\" mass=\"1\"/>\
                 <body name=\"b\" pos=\"0 0 -0.5\"><joint name=\"j2\" axis=\"0 1 0\"/>\
                 <geom type=\"capsule\" fromto=\"0 0 0 0 0 -0.5\" size=\"0.04\" mass=\"1\"/>\
                 <site name=\"s\" pos=\"0 0 -0.5\"/></body></body></worldbody>\
                 <equality><connect body1=\"b\" anchor=\"0 0 -0.5\"/></equality></mujoco>";
    let robot = file(&folder, "pinned.xml", robot);
    let refused = |arguments: &[&str]| {
        let (code, why) = complaint(arguments);
        assert!(code == 1 && why.contains("with 3 constraint rows") && why.contains("without constraints"), "{why}");
    };
    refused(&["ik", &robot, "--end-effector", "s", "--position", "0.3,0,-0.3"]);
    let (_, why) = complaint(&["trajectory", &robot, "--to", "0.3,0.2", "--time", "1"]);
    assert!(why.contains("which a path of its joints does not keep"), "{why}");
    refused(&["excite", &robot, "--duration", "2", "--max-velocity", "1", "--max-acceleration", "1"]);
    let rows: String = (0..30).map(|k| format!("{k},0.{k},0.1,1,2\n")).collect();
    let log = file(&folder, "log.csv", &format!("t,theta_1,theta_2,tau_1,tau_2\n{rows}"));
    refused(&["identify", &robot, &log]);
}

/// URDF and SDFormat keep points of two links, as Drake's element, which has no name. A note names each constraint and
/// each name that is lost.
#[test]
fn points_of_two_links_are_kept_by_every_format() {
    let folder = folder("constraints-drake");
    let robot = r#"<robot name="bar" xmlns:drake="https://drake.mit.edu"><link name="base"/><link name="a"><inertial>
        <mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
        </link><joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/></joint>
        <joint name="k" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.3 0 0"/>
        <axis xyz="0 1 0"/></joint></robot>"#;
    let robot = file(&folder, "bar.urdf", robot);
    let loops = r#"{"constraints": [
        {"name": "rod", "kind": "distance", "length": 0.5, "a": {"frame": "base"}, "b": {"frame": "b"}},
        {"name": "pin", "kind": "point", "a": {"frame": "base", "xyz": [0.6, 0, 0]}, "b": {"frame": "b", "xyz": [0.3, 0, 0]}}]}"#;
    let loops = file(&folder, "loops.json", loops);
    let whole = folder.join("whole.json").display().to_string();
    common::text(&["convert", &robot, &whole, "--constraints", &loops]);
    for ending in ["urdf", "sdf"] {
        let out = folder.join(format!("out.{ending}")).display().to_string();
        let said = common::mozzi(&["convert", &whole, &out]);
        let said = String::from_utf8(said.stderr).expect("text");
        let text = std::fs::read_to_string(&out).expect("written");
        assert_eq!(text.matches("<drake:ball_constraint>").count(), 1, "{text}");
        assert!(said.contains("`rod`") && said.contains("the name of constraint `pin`"), "{said}");
        assert!(common::text(&["info", &out]).contains("ball_constraint0"));
    }
}
