//! A floating base on the command line: its layout and names; every command accepts it.

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, numbers, rows, text, times};

const TREE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/test_tree.urdf");
const THETA: &str = "0.8,0.2,-0.4,0.4,0.1,0.2,0.6,0.3,-0.5,0.7,0.2,-0.1";
const DTHETA: &str = "0.3,-0.2,0.1,0.5,0,0.1,1,-0.4,0.3,0.6,-1";

fn names(value: &serde_json::Value) -> Vec<&str> {
    value.as_array().expect("a list").iter().map(|name| name.as_str().expect("a text")).collect()
}

#[test]
fn the_layout_is_told_by_names() {
    let info = json(&["info", TREE, "--floating"]);
    assert_eq!((&info["base"], &info["n"], &info["nq"]), (&"floating".into(), &11.into(), &12.into()));
    assert_eq!(
        names(&info["positions"])[..7],
        ["base.qw", "base.qx", "base.qy", "base.qz", "base.x", "base.y", "base.z"]
    );
    assert_eq!(names(&info["velocities"])[..6], ["base.wx", "base.wy", "base.wz", "base.vx", "base.vy", "base.vz"]);
    assert_eq!(names(&info["positions"])[7..], names(&info["independent_joints"]));
    let fixed = json(&["info", TREE]);
    assert_eq!((&fixed["base"], &fixed["positions"]), (&"fixed".into(), &fixed["independent_joints"]));
    assert!(text(&["info", TREE, "--floating"]).contains("a floating base, 5 independent joints and 2 mimic joints"));
    assert!(text(&["screws", TREE, "--floating", "--all"]).contains("G_0, the base"));
    assert_eq!(json(&["screws", TREE, "--floating"])["base"], "floating");
    let output = mozzi(&["check", TREE, "--floating"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("a floating base"), "{output:?}");
}

#[test]
fn inverse_and_forward_dynamics_at_a_pose() {
    let state = [TREE, "--floating", "--theta", THETA, "--dtheta", DTHETA];
    let compute = |quantity: &str, more: &[&str]| json(&[&["compute", TREE, quantity], &state[1..], more].concat());
    let ddtheta = "1,2,3,-1,-2,-3,0.5,0.4,0.3,0.2,0.1";
    let inverse = compute("inverse-dynamics", &["--ddtheta", ddtheta]);
    let tau = numbers(&inverse["tau"]);
    let list = tau.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    for by in ["", "-by-mass-matrix", "-by-inverse-dynamics"] {
        let forward = compute(&format!("forward-dynamics{by}"), &["--tau", &list]);
        assert_close(&numbers(&forward["ddtheta"]), &numbers(&inverse["ddtheta"]), 1e-10);
    }
    let terms = json(&[&["terms"][..], &state, &["--ddtheta", ddtheta, "--stacked"]].concat());
    assert_close(&numbers(&terms["inverse_dynamics"]), &tau, 0.0);
    let (M, h) = (rows(&terms["mass_matrix"]), numbers(&terms["bias_forces"]));
    let friction = numbers(&terms["joint_friction"]);
    let sum: Vec<f64> =
        times(&M, &numbers(&inverse["ddtheta"])).iter().zip(&h).zip(friction).map(|((a, b), c)| a + b + c).collect();
    assert_close(&sum, &tau, 1e-11);
    assert_close(&rows(&terms["closed_form"]["mass_matrix"]).concat(), &M.concat(), 1e-11);
    let page = text(&[&["terms"][..], &state, &["--stacked", "-v"]].concat());
    for words in [
        "with a floating base, 5 joints: 12 positions θ and 11 velocities θ̇",
        "base.qw",
        "base.vz",
        "link 1 being the floating base",
    ] {
        assert!(page.contains(words), "{words} in {page}");
    }
}

#[test]
fn nothing_given_is_the_neutral_pose() {
    let terms = json(&["terms", "ur5", "--floating"]);
    assert_eq!(numbers(&terms["theta"])[..7], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    // free fall: everything falls together
    let fall = numbers(&json(&["compute", "ur5", "forward-dynamics", "--floating"])["ddtheta"]);
    assert_close(&fall, &[0.0, 0.0, 0.0, 0.0, 0.0, -9.81, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-9);
}

#[test]
fn tables_name_their_columns() {
    let folder = folder("floating_tables");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    let (fall, torques) = (path("fall.csv"), path("torques.csv"));
    let state = [TREE, "--floating", "--theta", THETA, "--dtheta", DTHETA];
    text(&[&["simulate"][..], &state, &["--time", "0.02", "--out", &fall]].concat());
    let read = |path: &str| std::fs::read_to_string(path).expect("a file");
    assert!(read(&fall).starts_with("t,theta_base.qw,theta_base.qx,"), "{}", read(&fall));
    text(&["compute", TREE, "inverse-dynamics", "--floating", "--in", &fall, "--out", &torques]);
    // a motion simulated without torques needs none
    let needed = json(&["compute", TREE, "inverse-dynamics", "--floating", "--in", &torques]);
    for tau in rows(&needed["tau"]) {
        assert_close(&tau, &[0.0; 11], 1e-9);
    }
    let shown = text(&[&["simulate"][..], &state, &["--time", "0.02"]].concat());
    assert!(shown.contains("com x") && shown.contains("gives all of θ"), "{shown}");
    // motors' torques alone: the base's six columns may be left out, but not some of them
    let joints = names(&json(&["info", TREE])["independent_joints"]).join(",tau_");
    let table = file(&folder, "motors.csv", &format!("t,tau_{joints}\n0,1,2,3,4,5\n1,1,2,3,4,5\n"));
    let motion = json(&[&["simulate"][..], &state, &["--time", "0.01", "--torque", &table]].concat());
    assert_eq!(rows(&motion["tau"])[0], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let some = file(&folder, "some.csv", &format!("t,tau_base.wx,tau_{joints}\n0,0,1,2,3,4,5\n"));
    let (code, message) = complaint(&["simulate", TREE, "--floating", "--torque", &some]);
    assert!(
        code == 1 && message.contains("column tau_base.wy is missing; the file has 6 of the 11 columns of forces"),
        "{message}"
    );
    let odd = file(&folder, "odd.csv", "theta_base.qq\n0\n");
    let (_, message) = complaint(&["compute", TREE, "inverse-dynamics", "--floating", "--in", &odd]);
    assert!(message.contains("theta: base.qw, base.qx") && message.contains("theta from 1 to 12"), "{message}");
}

#[test]
fn a_fall_is_seen_in_the_table() {
    // ½ g t² = 0.4414 m, next to a quaternion that stays 1
    let page = text(&["simulate", "anymal", "--floating", "--time", "0.3"]);
    assert!(page.contains("-0.441"), "{page}");
}

#[test]
fn wrong_layouts() {
    let wrong = |arguments: &[&str], words: &str| {
        let (code, message) = complaint(arguments);
        assert!(code == 1 && message.contains(words), "{message}");
    };
    wrong(
        &["terms", "ur5", "--floating", "--theta", "0,0,0,0,0"],
        "--theta has 5 entries, expected 13: base quaternion (w, x, y, z), base origin, then 6 joints",
    );
    wrong(
        &["terms", "ur5", "--floating", "--dtheta", "0"],
        "--dtheta has 1 entry, expected 12: base twist (ω, v), then 6 joints",
    );
    wrong(
        &["compute", "ur5", "forward-dynamics", "--floating", "--tau", "0,1"],
        "expected 12: base wrench (m, f), then 6 joints",
    );
    wrong(
        &["terms", "ur5", "--floating", "--theta", "0,0,0,0,0,0,0,0,0,0,0,0,0"],
        "the base's orientation in theta is [0.0, 0.0, 0.0, 0.0], of length 0, expected a unit quaternion (w, x, y, z)",
    );
}

#[test]
fn files_carry_the_base() {
    let folder = folder("floating_files");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    let (first, second, python) = (path("a.json"), path("b.urdf"), path("c.py"));
    text(&["convert", TREE, "--floating", &first]);
    text(&["convert", &first, &second]);
    let expected = json(&["terms", TREE, "--floating", "--theta", THETA]);
    for robot in [&first, &second] {
        let found = json(&["terms", robot, "--theta", THETA]);
        assert_eq!(found["velocities"], expected["velocities"]);
        assert_close(&rows(&found["mass_matrix"]).concat(), &rows(&expected["mass_matrix"]).concat(), 1e-12);
    }
    text(&["convert", "ur5", "--floating", &python]);
    let literals = std::fs::read_to_string(&python).expect("a file");
    assert!(literals.contains("base = \"floating\"\nGbase = np.array("), "{literals}");
    // a file that does not specify the base has a fixed one
    let robot: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&first).expect("it")).expect("JSON");
    let edited = |base: Option<&str>| {
        let mut robot = robot.clone();
        match base {
            Some(base) => robot["base"] = base.into(),
            None => robot.as_object_mut().expect("an object").retain(|key, _| key != "base" && key != "free_joint"),
        }
        file(&folder, "edited.json", &robot.to_string())
    };
    assert_eq!(json(&["info", &edited(None)])["base"], "fixed");
    let (_, message) = complaint(&["info", &edited(Some("bolted"))]);
    assert!(message.contains("base is \"bolted\", expected \"fixed\" or \"floating\""), "{message}");
}
