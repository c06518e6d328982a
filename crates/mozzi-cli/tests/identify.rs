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
    assert!(why.contains("column q2 is missing") && why.contains("--lock joint2=POSITION"), "{why}");
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

#[test]
fn a_motion_tells_the_rotor_of_coupled_joints() {
    let told = text(&["excite", "double_pendulum", "--duration", "5", "--coupled", "joint1,joint2=-2", "--all"]);
    assert!(told.contains("joint1+joint2.armature") && told.contains("joint1+joint2.friction"), "{told}");
    let (_, why) = complaint(&["excite", "double_pendulum", "--coupled", "joint1,elbow"]);
    assert!(why.contains("--coupled joint1,elbow: there is no joint `elbow`; the robot has joint1, joint2"), "{why}");
    let (_, why) = complaint(&["excite", "double_pendulum", "--coupled", "joint1"]);
    assert!(why.contains("one joint, expected two or more with commas"), "{why}");
}

/// A log of a PD law whose targets are logged five rows before they act, so that gains and delay are known.
fn controlled(folder: &Path) -> String {
    let rows = std::fs::read_to_string(motion(folder)).expect("rows");
    let table: Vec<Vec<f64>> =
        rows.lines().skip(1).map(|row| row.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    let names: Vec<&str> = rows.lines().next().expect("a header").split(',').collect();
    let at = |name: &str| names.iter().position(|known| *known == name).expect("a column");
    let mut text = "t,q_1,q_2,qd_1,qd_2,tau_1,tau_2,target_q_1,target_q_2\n".to_string();
    for k in 0..table.len() - LATE {
        let wanted = |j: usize, kp: f64, kd: f64| {
            let value = |what: &str| table[k + LATE][at(&format!("{what}_{j}"))];
            value("theta") + (value("tau") + kd * value("dtheta")) / kp
        };
        let own = ["t", "theta_1", "theta_2", "dtheta_1", "dtheta_2", "tau_1", "tau_2"].map(|name| table[k][at(name)]);
        let all: Vec<String> =
            own.into_iter().chain([wanted(1, 120.0, 9.0), wanted(2, 40.0, 3.0)]).map(|x| x.to_string()).collect();
        text += &(all.join(",") + "\n");
    }
    common::file(folder, "controlled.csv", &text)
}

/// Rows between a target and its effect.
const LATE: usize = 5;

#[test]
fn gains_and_delay_of_a_position_controlled_log() {
    let folder = folder("identify_servo");
    let log = controlled(&folder);
    let found = json(&["identify", "double_pendulum", &log]);
    let servos = found["servos"].as_array().expect("a list");
    assert_eq!(servos.len(), 2, "{found}");
    let text_of = std::fs::read_to_string(&log).expect("rows");
    let time = |row: usize| -> f64 {
        text_of.lines().nth(row + 1).and_then(|row| row.split(',').next()).and_then(|t| t.parse().ok()).expect("a time")
    };
    let delay = LATE as f64 * (time(1) - time(0));
    for (servo, [kp, kd]) in servos.iter().zip([[120.0, 9.0], [40.0, 3.0]]) {
        let value = |name: &str| servo[name][0].as_f64().expect("a number");
        assert!((value("stiffness") / kp - 1.0).abs() < 0.05, "{servo}");
        assert!((value("damping") / kd - 1.0).abs() < 0.05, "{servo}");
        assert!((servo["delay"].as_f64().expect("a number") / delay - 1.0).abs() < 0.05, "{servo} {delay}");
    }
    let shown = text(&["identify", "double_pendulum", &log, "--columns"]);
    assert!(shown.contains("target position θ*"), "{shown}");
    // each simulator has its own words, and each parameter its place
    for (simulator, words) in [
        ("mjcf", ["<position name=\"joint1\" joint=\"joint1\" kp=", "position kv", "frictionloss"]),
        (
            "mjlab",
            [
                "BuiltinPositionActuatorCfg(target_names_expr=(r\"joint1\",), stiffness=",
                "delay_min_lag=lag",
                "frictionloss=",
            ],
        ),
        ("isaac", ["DelayedPDActuatorCfg(", "viscous_friction={r\"joint1\": ", "min_delay=lag"]),
        ("urdf", ["<joint name=\"joint1\" …> <dynamics", "none in URDF", "<dynamics friction>"]),
    ] {
        let told = text(&["identify", "double_pendulum", &log, "--write", simulator]);
        assert!(words.iter().all(|word| told.contains(word)), "{simulator}: {told}");
        assert!(told.contains("position controllers; targets act") && told.contains("where it went"), "{told}");
    }
    // without targets there are no gains to write
    let way = path(&folder, "way.csv");
    let told = text(&["identify", "double_pendulum", &way, "--write", "mjlab"]);
    assert!(told.contains("BuiltinMotorActuatorCfg(") && told.contains("no targets logged"), "{told}");
}
