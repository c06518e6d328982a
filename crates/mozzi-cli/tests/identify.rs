//! `mozzi excite` and `mozzi identify`.

use crate::common;

use common::{complaint, folder, json, mozzi, numbers, text};
use std::path::Path;

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("a path of text").to_string()
}

/// A motion of the double pendulum with its own torques.
fn motion(folder: &Path) -> String {
    let way = path(folder, "way.csv");
    let limits = ["--max-velocity", "3", "--max-acceleration", "10", "--harmonics", "3"];
    let told = text(&[&["excite", "double_pendulum", "--duration", "5", "--out", &way], &limits[..]].concat());
    assert!(told.contains("condition number") && told.contains("rod2.mcz"), "{told}");
    way
}

#[test]
fn a_robots_own_motion_is_identified() {
    let folder = folder("identify");
    let way = motion(&folder);
    let [out, report] = ["out.urdf", "fit.html"].map(|name| path(&folder, name));
    let told = text(&["identify", "double_pendulum", &way, "--out", &out, "--report", &report]);
    assert!(told.contains("five blocks of time left out in turn"), "{told}");
    let report = std::fs::read_to_string(report).expect("a report");
    assert!(report.starts_with("<!doctype html>") && report.contains("<svg") && !report.contains("<script"));
    assert!(report.contains("default-src 'none'"));
    let found = json(&["identify", "double_pendulum", &way]);
    assert!(found["left_out"]["nrms"].as_f64().expect("a number") < 0.01, "{found}");
    let (force, error) = (numbers(&found["fitted"]["force"]), numbers(&found["fitted"]["consistent"]));
    assert!(error.iter().zip(force).all(|(e, f)| *e < 0.01 * f));
    // the result is a robot that mozzi reads, with the same torques
    let again = json(&["identify", &out, &way]);
    assert!(again["left_out"]["nrms"].as_f64().expect("a number") < 0.01);
    let robot = text(&["info", &out]);
    assert!(robot.contains("2 moving links") || robot.contains("joint2"), "{robot}");
}

#[test]
fn swapped_joints_and_other_names_are_noticed() {
    let folder = folder("identify_names");
    let way = motion(&folder);
    let rows = std::fs::read_to_string(&way).expect("rows");
    let (header, rest) = rows.split_once('\n').expect("a header");
    let swapped = header.replace("_1", "_x").replace("_2", "_1").replace("_x", "_2");
    let file = path(&folder, "swapped.csv");
    std::fs::write(&file, format!("{swapped}\n{rest}")).expect("a file");
    let output = mozzi(&["identify", "double_pendulum", &file]);
    let messages = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(messages.contains("the columns of joint1 and joint2 seem to be swapped"), "{messages}");
    let renamed = header.replace("dd", "acc_").replace("theta_1", "pos_a").replace("theta_2", "pos_b");
    let renamed = renamed
        .replace("dpos", "vel")
        .replace("acc_pos", "acc")
        .replace("tau_1", "effort_a")
        .replace("tau_2", "effort_b");
    std::fs::write(&file, format!("{renamed}\n{rest}")).expect("a file");
    let (_, why) = complaint(&["identify", "double_pendulum", &file, "--fit", "70"]);
    assert!(why.contains("if this is the robot's order: --order a,b"), "{renamed}: {why}");
    text(&["identify", "double_pendulum", &file, "--fit", "70", "--order", "a,b"]);
}

#[test]
fn bad_input_is_refused() {
    let folder = folder("identify_bad");
    let file = common::file(&folder, "short.csv", "t,q1,q2,tau1,tau2\n0,0,0,0,0\n0.1,0,0,0,0\n");
    let (_, why) = complaint(&["identify", "double_pendulum", &file]);
    assert!(why.contains("2 usable rows") || why.contains("1 usable rows"), "{why}");
    let file = common::file(&folder, "names.csv", "t,q1,tau1\n0,0,0\n");
    let (_, why) = complaint(&["identify", "double_pendulum", &file]);
    assert!(why.contains("column theta_2 is missing") && why.contains("--lock joint2=POSITION"), "{why}");
    let (_, why) = complaint(&["identify", "double_pendulum", &file, "--out", "robot.txt"]);
    assert!(why.contains("expected a name that ends in .urdf, .json, .xml (MJCF)"), "{why}");
    let (_, why) = complaint(&["identify", "double_pendulum", &file, "--fit", "55"]);
    assert!(why.contains("--fit is 55"), "{why}");
    let (_, why) = complaint(&["identify", "double_pendulum", &file, "--payload", "rod2"]);
    assert!(why.contains("--only payload"), "{why}");
    let (_, why) = complaint(&["excite", "double_pendulum", "--duration", "-1"]);
    assert!(why.contains("the duration is -1 s"), "{why}");
    let (_, why) = complaint(&["excite", "double_pendulum", "--range", "elbow=0,1"]);
    assert!(why.contains("there is no joint `elbow`"), "{why}");
}
