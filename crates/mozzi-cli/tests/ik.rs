//! `mozzi ik`, against `mozzi terms` and the robot's limits.

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, numbers, text};

#[test]
fn what_is_found_is_where_it_should_be() {
    let found = json(&["ik", "ur5", "--position", "0.4,0.2,0.5", "--rpy", "3,0.2,-0.1"]);
    let theta: Vec<String> = numbers(&found["theta"]).iter().map(|x| format!("{x:?}")).collect();
    let terms = json(&["terms", "ur5", &format!("--theta={}", theta.join(","))]);
    let T: Vec<f64> = common::rows(&terms["forward_kinematics"]).concat();
    assert_close(&[T[3], T[7], T[11]], &[0.4, 0.2, 0.5], 1e-8);
    assert_close(&T, &common::rows(&found["T"]).concat(), 1e-15);
    let (roll, pitch) = (T[9].atan2(T[10]), (-T[8]).asin());
    assert_close(&[roll, pitch, T[4].atan2(T[0])], &[3.0, 0.2, -0.1], 1e-7);
    // a position alone, and the solution nearest to a posture
    let posture = "0,-0.5,0,-1.5,0,1.5,0,0.02";
    let found = json(&["ik", "panda", "--frame", "panda_hand", "--position", "0.4,0.2,0.5", "--near", posture]);
    assert!(found["angle"].is_null() && found["distance"].as_f64().expect("asked for") < 1e-8);
    assert!(text(&["ik", "ur5", "--position", "0.4,0.2,0.5"]).contains("`tool0` reaches its goal within"));
}

#[test]
fn tables_in_tables_out() {
    let folder = folder("ik");
    let goals = file(&folder, "goals.csv", "qw,qx,qy,qz,x,y,z\n1,0,0,0,0.4,0.2,0.5\n0,1,0,0,0.3,-0.3,0.4\n");
    let out = folder.join("theta.csv");
    let out = out.to_str().expect("text");
    assert!(text(&["ik", "ur5", "--in", &goals, "--out", out]).contains("2 rows written"));
    let rows = std::fs::read_to_string(out).expect("written");
    assert!(
        rows.starts_with("theta_1,theta_2,theta_3,theta_4,theta_5,theta_6,reached,angle,distance,starts,iterations\n")
    );
    assert_eq!(rows.lines().count(), 3);
    let found = json(&["ik", "ur5", "--in", &goals]);
    assert_eq!((&found["frame"], &found["complete"]), (&"tool0".into(), &true.into()));
    assert_eq!(numbers(&found["reached"]), [1.0, 1.0]);
    let row: Vec<f64> = rows.lines().nth(1).expect("a row").split(',').map(|x| x.parse().expect("a number")).collect();
    assert_close(&common::rows(&found["theta"])[0], &row[..6], 0.0);
    // as a spreadsheet with decimal commas writes them
    let commas = file(&folder, "commas.csv", "qw;qx;qy;qz;x;y;z\n1;0;0;0;0,4;0,2;0,5\n0;1;0;0;0,3;-0,3;0,4\n");
    assert_eq!(json(&["ik", "ur5", "--in", &commas])["theta"], found["theta"]);
    // one pose out of reach: its row is the best result, and the exit code reports it
    let goals = file(&folder, "far.csv", "x,y,z,qw,qx,qy,qz\n0.4,0.2,0.5,1,0,0,0\n3,0,0,1,0,0,0\n");
    let output = mozzi(&["ik", "ur5", "--in", &goals, "--starts", "3"]);
    assert_eq!(output.status.code(), Some(1));
    let (rows, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let reached: Vec<&str> = rows.lines().skip(1).filter_map(|row| row.split(',').nth(6)).collect();
    assert_eq!(reached, ["1.0", "0.0"]);
    assert!(said.contains("1 of 2 poses reached") && said.contains("the first in line 3 of"), "{said}");
}

#[test]
fn wrong_goals() {
    let wrong = |arguments: &[&str], words: &[&str]| {
        let (code, message) = complaint(&[&["ik", "ur5"], arguments].concat());
        assert!(code == 1 && words.iter().all(|word| message.contains(word)), "{message}");
    };
    wrong(&[], &["the goal is missing", "--position"]);
    wrong(&["--position", "3,0,0", "--starts", "2"], &["m out of reach", "leaves `tool0`", "2 starts"]);
    wrong(&["--quaternion", "1,1,0,0"], &["--quaternion", "length is 1.41"]);
    wrong(&["--position", "1,2"], &["2 entries, expected 3"]);
    wrong(&["--position", "0.3,0,0.3", "--angle", "0"], &["angle is 0"]);
    let folder = folder("ik_wrong");
    for (name, text, words) in [
        ("missing.csv", "x,y,z,qw,qx,qy\n", "column `qz` is missing"),
        ("double.csv", "x,y,z,x\n", "columns 1 and 4 are both called `x`"),
        ("unknown.csv", "x,y,z,qw,qx,qy,qz,f\n", "column 8 is called `f`"),
        ("empty.csv", "x,y,z,qw,qx,qy,qz\n", "no rows"),
        ("long.csv", "x,y,z,qw,qx,qy,qz\n0,0,0,2,0,0,0\n", "long.csv:2: qw qx qy qz: the quaternion's length is 2"),
        ("text.csv", "x,y,z,qw,qx,qy,qz\n0,0,a,1,0,0,0\n", "text.csv:2: column 3 (`z`) is `a`"),
    ] {
        wrong(&["--in", &file(&folder, name, text)], &[words]);
    }
}

/// SDFormat joints with a lower limit alone.
#[test]
fn a_missing_limit_is_none() {
    let joint = |kind: &str, parent: &str, child: &str, axis: &str| {
        let ends = format!("<parent>{parent}</parent><child>{child}</child>");
        let axis = format!("<axis><xyz>{axis}</xyz><limit><lower>0</lower></limit></axis>");
        format!("<joint name=\"to_{child}\" type=\"{kind}\">{ends}{axis}</joint>")
    };
    let links = ["a", "b"].map(|name| format!("<link name=\"{name}\"><pose>0 0 0.4 0 0 0</pose></link>")).concat();
    let fixed = "<joint name=\"fix\" type=\"fixed\"><parent>world</parent><child>base</child></joint>";
    let joints = [joint("revolute", "base", "a", "0 1 0"), joint("prismatic", "a", "b", "1 0 0")].concat();
    let model = format!("<model name=\"m\"><link name=\"base\"/>{fixed}{links}{joints}</model>");
    let robot = file(&folder("ik_one_sided"), "arm.sdf", &format!("<sdf version=\"1.9\">{model}</sdf>"));
    let page = text(&["info", &robot]);
    assert!(page.contains("lowest") && !page.contains("highest"), "{page}");
    let found = json(&["ik", &robot, "--end-effector", "b", "--position=-0.9,0,0.4"]);
    let theta = numbers(&found["theta"]);
    assert!((theta[0] - std::f64::consts::PI).abs() < 1e-6 && (theta[1] - 0.9).abs() < 1e-6, "{theta:?}");
}
