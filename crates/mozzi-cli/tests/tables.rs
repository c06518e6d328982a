//! Tables in and out, and the tour.

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, numbers, rows, text};
use std::io::Write;
use std::process::{Command, Stdio};

/// The columns of a group in the header, and their values in the rows of a table.
fn group(table: &str, name: &str) -> Vec<Vec<f64>> {
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let picked: Vec<usize> = (0..header.len()).filter(|&c| header[c].starts_with(&format!("{name}_"))).collect();
    assert!(!picked.is_empty(), "{name} in {header:?}");
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            picked.iter().map(|&c| cells[c].parse().expect("a number")).collect()
        })
        .collect()
}

const STATES: &str = "\
# two states of a UR5, by numbers and by names
t, ddtheta_1, ddtheta_2, ddtheta_3, ddtheta_4, ddtheta_5, ddtheta_6, theta_1, theta_2, theta_elbow_joint, theta_4, theta_5, theta_6, m_x, m_y, m_z, f_x, f_y, f_z
0.0, 1, 0.5, -1, 2, 0, -0.5, 0.1, -1.2, 1.5, 0.3, 1.1, 0, 0, 0, 0.5, 0, 0, 20
0.1, -1, 0.25, 3, 1, 2, 1e-3, 0.2, -1.1, 1.4, 0.2, 1.0, 0.1, 0, 0, 0, 0, 0, 0
";

#[test]
fn inverse_then_forward_dynamics_returns_the_accelerations() {
    let folder = folder("round_trip");
    let (states, torques) = (file(&folder, "states.csv", STATES), file(&folder, "torques.csv", ""));
    let output = mozzi(&["compute", "ur5", "inverse-dynamics", "--in", &states, "--out", &torques]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.starts_with("2 states in ") && said.contains(&torques), "{said}");
    let table = text(&["compute", "ur5", "forward-dynamics", "--in", &torques]);
    let expected = [[1.0, 0.5, -1.0, 2.0, 0.0, -0.5], [-1.0, 0.25, 3.0, 1.0, 2.0, 1e-3]];
    for (found, expected) in group(&table, "ddtheta").iter().zip(&expected) {
        assert_close(found, expected, 1e-10);
    }
    assert_eq!(group(&table, "f"), [[0.0, 0.0, 20.0], [0.0; 3]]);

    let json = json(&["compute", "ur5", "forward-dynamics", "--in", &torques]);
    for (found, expected) in rows(&json["ddtheta"]).iter().zip(group(&table, "ddtheta")) {
        assert_close(found, &expected, 1e-14); // the test's JSON reader is off by an ulp
    }
    assert_eq!(numbers(&json["t"]), [0.0, 0.1]);
}

#[test]
fn tables_go_through_pipes() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(["compute", "two_link_planar", "inverse-dynamics", "--in", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program runs");
    child.stdin.take().expect("a pipe").write_all(b"theta_1,theta_2\n0,0\n").expect("a pipe");
    let table = String::from_utf8(child.wait_with_output().expect("an end").stdout).expect("text");
    // (m1 + m2) g L1 + m2 g L2 with m = 2, 1 kg and L = 0.5, 0.4 m
    assert_close(&group(&table, "tau")[0], &[9.81 * (1.5 + 0.4), 9.81 * 0.4], 1e-13);
}

#[test]
fn a_closed_pipe_ends_in_silence() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(["simulate", "ur5", "--out", "-"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_simulation_is_driven_by_tables_and_read_by_inverse_dynamics() {
    let folder = folder("driven");
    let torque = file(&folder, "torque.csv", "t,tau_1,tau_2\n0,1,0.5\n0.2,-1,0.25\n");
    let wrench = file(&folder, "wrench.csv", "t,m_x,m_y,m_z,f_x,f_y,f_z\n0,0,0,0,1,0,0\n0.1,0,0,0,0,0,2\n");
    let out = folder.join("motion.csv").to_str().expect("text").to_string();
    let base =
        ["simulate", "two_link_planar", "--theta", "0.3,-0.4", "--torque", &torque, "--time", "0.2", "--out", &out];
    let said = text(&base);
    assert!(said.contains("201 rows written to"), "{said}");
    let motion = std::fs::read_to_string(&out).expect("a table");
    assert_close(&group(&motion, "tau")[100], &[0.0, 0.375], 1e-12);
    let again = text(&["compute", "two_link_planar", "inverse-dynamics", "--in", &out]);
    for (given, found) in group(&motion, "tau").iter().zip(group(&again, "tau")) {
        assert_close(given, &found, 1e-11);
    }

    let with_wrench = [&base[..], &["--tip-wrench", &wrench]].concat();
    let (code, message) = complaint(&with_wrench);
    assert!(code == 1 && message.contains("wrench.csv covers t = 0 s to 0.1 s, expected 0 s to 0.2 s"), "{message}");
    text(&[&with_wrench[..], &["--extrapolate", "hold"]].concat());
    assert_ne!(motion, std::fs::read_to_string(&out).expect("a table"));
    text(&[&base[..], &["--tip-wrench", "0,0,0,-1,0,0"]].concat());
}

#[test]
fn the_tour_shows_a_robot_whole_and_writes_nothing() {
    let folder = folder("tour");
    let tour = |arguments: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_mozzi"));
        program.current_dir(&folder).args(arguments).output().expect("the program runs")
    };
    let output = tour(&[]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = String::from_utf8(output.stdout).expect("text");
    for word in ["shoulder_pan_joint", "M(θ)", "= τ", "semi-implicit Euler", "Runge-Kutta 4"] {
        assert!(page.contains(word), "{word} in {page}");
    }
    assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 0);
    assert!(tour(&["--out", "fall.csv"]).status.success());
    let table = std::fs::read_to_string(folder.join("fall.csv")).expect("a table");
    assert_eq!(table.lines().count(), 1 + 2 * 2001);
    assert!(table.starts_with("method,t,theta_1,"));
    assert_eq!(mozzi(&["check", "ur5"]).status.code(), Some(0));
}
