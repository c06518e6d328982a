//! Values as people type them, and notes about what has no effect.

use crate::common::{complaint, file, folder, json, mozzi, numbers, text};

const Q: &str = "--q=0,-1.2,1.5,0.3,1.1,0";

fn said(arguments: &[&str]) -> String {
    let output = mozzi(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn gravity_with_a_sign_is_no_size() {
    let (code, message) = complaint(&["compute", "ur5", "g", "--gravity", "-9.81"]);
    assert!(code == 1 && message.contains("expected 9.81, or the vector 0,0,-9.81"), "{message}");
}

#[test]
fn joints_are_given_by_name() {
    let of = |q: &str| numbers(&json(&["compute", "ur5", "g", q])["theta"]);
    assert_eq!(of("--q=elbow_joint=0.5,shoulder_lift_joint=-1"), [0.0, -1.0, 0.5, 0.0, 0.0, 0.0]);
    assert!((of("--q=elbow_joint=90deg")[2] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let (_, message) = complaint(&["compute", "ur5", "g", "--q=elbw_joint=1"]);
    assert!(message.contains("there is no joint `elbw_joint`; did you mean `elbow_joint`?"), "{message}");
    let (_, message) = complaint(&["compute", "ur5", "g", "--q=elbow_joint=1,2"]);
    assert!(message.contains("`2` has no name"), "{message}");
}

#[test]
fn the_joints_of_a_floating_base_may_stand_alone() {
    let q = "--q=0,0.8,-1.6,0,0.8,-1.6,0,-0.8,1.6,0,-0.8,1.6";
    let found = json(&["compute", "anymal", "M", "--floating", q]);
    let theta = numbers(&found["theta"]);
    assert_eq!((theta.len(), &theta[..4], theta[8]), (19, &[1.0, 0.0, 0.0, 0.0][..], 0.8));
    // on the ground such a start stands on it
    let arguments = ["simulate", "anymal", "--floating", "--ground", q, "--time", "0.002"];
    assert!(said(&arguments).contains("where its lowest contact point touches"));
    let (_, message) = complaint(&["compute", "anymal", "M", &format!("{q},0,0,0,0,0,0,0")]);
    assert!(message.contains("--floating frees the base"), "{message}");
}

#[test]
fn a_plane_of_the_file_without_ground_is_named() {
    let folder = folder("typed_planes");
    let robot = "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'>\
                 <freejoint/><geom size='0.1'/></body></worldbody></mujoco>";
    let robot = file(&folder, "ball.xml", robot);
    let note = "the file's plane `floor` is not used; --ground puts the robot on it";
    assert!(said(&["simulate", &robot, "--time", "0.01"]).contains(note));
    assert!(!said(&["simulate", &robot, "--time", "0.01", "--ground"]).contains(note));
}

#[test]
fn symbols_of_printed_results_are_names() {
    for (guess, name) in [
        ("eta", "task-space-dynamics"),
        ("K", "kinetic-energy"),
        ("P", "potential-energy"),
        ("Mdot", "mass-matrix-rate"),
    ] {
        assert_eq!(text(&["compute", "ur5", guess, Q]), text(&["compute", "ur5", name, Q]), "{guess}");
    }
    let (_, message) = complaint(&["compute", "ur5", "h_foo"]);
    assert!(message.contains("there is no quantity `h_foo`"), "{message}");
}

#[test]
fn goals_in_a_table_may_leave_the_orientation_free() {
    let folder = folder("typed_goals");
    let goals = file(&folder, "positions.csv", "x,y,z\n0.4,0.2,0.5\n0.3,-0.3,0.4\n");
    let found = json(&["ik", "ur5", "--in", &goals]);
    assert_eq!(numbers(&found["reached"]), [1.0, 1.0]);
    let goals = file(&folder, "rpy.csv", "x,y,z,roll,pitch,yaw\n0.4,0.2,0.5,0.1,0.2,0.3\n");
    let row = numbers(&json(&["ik", "ur5", "--in", &goals])["theta"][0]);
    let alone = json(&["ik", "ur5", "--position", "0.4,0.2,0.5", "--rpy", "0.1,0.2,0.3"]);
    assert_eq!(row, numbers(&alone["theta"]));
    let both = file(&folder, "both.csv", "roll,pitch,yaw,qw,qx,qy,qz\n0,0,0,1,0,0,0\n");
    assert!(complaint(&["ik", "ur5", "--in", &both]).1.contains("two orientations"));
}

#[test]
fn conditions_take_degrees() {
    let end = |condition: &str| {
        json(&["simulate", "double_pendulum", "--q=1,0", "--until", condition])["t"]
            .as_array()
            .and_then(|t| t.last().cloned())
    };
    let joint = json(&["info", "double_pendulum"])["joints"][0]["name"].as_str().map(str::to_string).expect("a joint");
    assert_eq!(end(&format!("{joint} < 45deg")), end(&format!("{joint} < {}", std::f64::consts::FRAC_PI_4)));
}

#[test]
fn joints_may_be_given_by_name() {
    let of = |rates: &str| numbers(&json(&["compute", "ur5", "c", &format!("--qd={rates}")])["c"]);
    assert_eq!(of("elbow_joint=1, wrist_1_joint=-2"), of("0,0,1,-2,0,0"));
    for (text, expected) in [
        ("elbow_joint=1,elbow_joint=2", "--dtheta: `elbow_joint` is given twice"),
        ("elbw_joint=1", "--dtheta: there is no joint `elbw_joint`; did you mean `elbow_joint`?"),
        ("elbow_joint=1,2", "--dtheta: `2` has no name"),
    ] {
        let (_, message) = complaint(&["compute", "ur5", "c", &format!("--qd={text}")]);
        assert!(message.contains(expected), "{message}");
    }
    let (_, message) = complaint(&["trajectory", "ur5", "--to", "1,1,1,1,1,1", "--max-velocity", "elbw_joint=1"]);
    assert!(
        message.contains("--max-velocity: there is no joint `elbw_joint`; did you mean `elbow_joint`?"),
        "{message}"
    );
}

#[test]
fn robots_that_are_meant_are_named() {
    for guess in ["ur55", "UR5", "./ur5.urdf"] {
        let (_, message) = complaint(&["info", guess]);
        assert!(message.contains("did you mean `ur5`?"), "{guess}: {message}");
    }
    let folder = folder("typed_robots");
    let table = file(&folder, "motion.csv", "t,theta_1\n0,1\n");
    assert!(complaint(&["info", &table]).1.contains("is it a table?"));
}

#[test]
fn a_diverging_motion_is_told_in_a_line() {
    let huge = mozzi(&["compute", "ur5", "c", "--qd=1e200,0,0,0,0,0"]);
    assert!(String::from_utf8_lossy(&huge.stderr).contains("velocity-product: the numbers are too large"));
    let note = said(&["terms", "ur5", "--q=1e300,0,0,0,0,0"]);
    assert!(note.lines().all(|line| line.len() < 300) && note.contains("1e300 is large"), "{note}");
    let page = text(&["simulate", "ur5", "--dt", "0.5", "--time", "1"]);
    assert!(page.contains("the step is too long, or another --method fits"), "{page}");
}
