//! What commands say about a log, and that all of them read it.

use super::OWN;
use super::motion::{ROBOT, clean};
use crate::common::{complaint, file, folder, json, mozzi, text};
use std::fmt::Write;

#[test]
fn the_verdict_comes_first_and_strict_runs_fail() {
    let folder = folder("identify_logs_verdict");
    let log = file(&folder, "log.csv", &clean().table(OWN, ","));
    let told = text(&["identify", ROBOT, &log]);
    let first = told.lines().next().expect("a line");
    assert!(first.starts_with("predicts unseen torques to ") && first.contains("the robot's file: "), "{first}");
    assert!(!told.contains("columns of ") && told.lines().count() < 40, "{told}");
    let all = text(&["identify", ROBOT, &log, "--all"]);
    assert!(all.contains("columns of ") && all.contains("velocity θ̇") && all.contains("kg m²"), "{all}");
    let columns = text(&["identify", ROBOT, &log, "--columns"]);
    assert!(columns.contains("dtheta_2") && columns.contains("rad/s") && !columns.contains("predicts"), "{columns}");
    let payload = text(&["identify", ROBOT, &log, "--only", "payload", "--payload", "tip"]);
    assert!(payload.starts_with("payload: ") && payload.contains(" m in tip, ± "), "{payload}");
    // a warning is an error under --strict
    let outs = clean().map(|k, q, v, tau| {
        if k % 97 == 40 {
            [q, v, tau].into_iter().flatten().for_each(|x| *x = 0.0);
        }
    });
    let warned = file(&folder, "warned.csv", &outs.table(OWN, ","));
    assert_eq!(mozzi(&["identify", ROBOT, &warned]).status.code(), Some(0));
    assert_eq!(mozzi(&["identify", ROBOT, &warned, "--strict"]).status.code(), Some(1));
    // a refused log is fitted on demand
    let swapped = file(&folder, "sign.csv", &clean().map(|_, _, _, tau| tau[1] = -tau[1]).table(OWN, ","));
    assert!(complaint(&["identify", ROBOT, &swapped]).1.contains("--trust-log"));
    let output = mozzi(&["identify", ROBOT, &swapped, "--trust-log"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("warning: "));
    // locks by pattern
    let locked = "t,theta_joint1,dtheta_joint1,tau_joint1";
    let m = clean();
    let mut rows = locked.to_string() + "\n";
    for k in 0..m.t.len() {
        writeln!(rows, "{},{},{},{}", m.t[k], m.theta[k][0], m.dtheta[k][0], m.tau[k][0]).expect("text");
    }
    let one = file(&folder, "one.csv", &rows);
    let why = complaint(&["identify", ROBOT, &one]).1;
    assert!(why.contains("--lock joint2=POSITION"), "{why}");
    let output = mozzi(&["identify", ROBOT, &one, "--lock", "*2=0", "--trust-log"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("joint2 are locked"));
}

#[test]
fn every_command_reads_a_drivers_names() {
    let folder = folder("identify_logs_commands");
    let names = "timestamp,q_0,q_1,qd_0,qd_1,tau_0,tau_1";
    let log = file(&folder, "log.csv", &clean().table(names, ","));
    let own = file(&folder, "own.csv", &clean().table(OWN, ","));
    let of = |table: &str| json(&["compute", ROBOT, "mass-matrix", "--in", table]);
    assert_eq!(of(&log), of(&own));
    let degrees = clean().map(|_, q, v, _| [q, v].into_iter().flatten().for_each(|x| *x = x.to_degrees()));
    let table = file(&folder, "deg.csv", &degrees.table("time_ms,q1_deg,q2_deg,qd1_deg/s,qd2_deg/s,tau1,tau2", ","));
    let output = mozzi(&["compute", ROBOT, "mass-matrix", "--in", &table]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stderr).contains("converted from deg"));
    let page = folder.join("page.html").to_string_lossy().into_owned();
    text(&["view", ROBOT, &log, "--out", &page]);
    let picture = folder.join("plot.svg").to_string_lossy().into_owned();
    text(&["plot", "trajectory", ROBOT, &log, "--out", &picture]);
}
