//! Flags without effect are refused, and so are unknown names.

use super::files::npz;
use crate::common::{complaint, folder, text};

fn wrong(arguments: &[&str], expected: &str) {
    let (code, message) = complaint(&[&["compute"], arguments].concat());
    assert!(code == 1 && message.contains(expected), "{arguments:?}: {message}");
}

#[test]
fn vjp_is_the_product_of_a_quantity() {
    let w = "1,2,3,4,5,6";
    let by_flag = text(&["compute", "ur5", "frame-acceleration", "--vjp", "--w", w, "--json"]);
    assert_eq!(by_flag, text(&["compute", "ur5", "frame-acceleration-vjp", "--w", w, "--json"]));
    wrong(
        &["ur5", "mass-matrix", "--vjp"],
        "--vjp: mass-matrix has no vector-Jacobian product, expected one of inverse-",
    );
    wrong(&["ur5", "momentum", "--vjp", "--w", "1,2"], "--w has 2 entries, expected 6");
}

#[test]
fn flags_without_an_effect_are_refused() {
    let zeros = "0,0,0,0,0,0";
    for (quantity, flag, value, takes) in [
        ("mass-matrix", "--tau", zeros, "--theta"),
        ("mass-matrix", "--dtheta", zeros, "--theta"),
        ("inverse-dynamics", "--tau", zeros, "--theta, --dtheta, --ddtheta, --tip-wrench, --wrench, --gravity"),
        ("inverse-dynamics", "--x", zeros, "--theta, --dtheta, --ddtheta, --tip-wrench, --wrench, --gravity"),
        ("coriolis-matrix", "--gravity", "0,0,0", "--theta, --dtheta"),
        ("gravity-forces", "--tip-wrench", zeros, "--theta, --gravity"),
        ("body-jacobian", "--wrench", "tool0=0,0,0,0,0,0", "--theta, --frame"),
        ("mass-matrix", "--frame", "tool0", "--theta"),
        ("inverse-dynamics", "--frame", "tool0", "--theta"),
        ("body-jacobian", "--task", "vx", "--theta, --frame, --state"),
        ("body-jacobian", "--task-frame", "body", "--theta, --frame"),
        ("task-space-dynamics", "--about", "0,0,0", "--theta, --dtheta, --frame, --task, --task-frame, "),
    ] {
        // --frame is another name of --end-effector
        let expected = format!("{flag} has no effect on {quantity}, which takes {takes}");
        wrong(&["ur5", quantity, flag, value], &expected);
    }
    let folder = folder("compute_flags");
    let states = npz(&folder, "states.npz", &[("theta", &[1, 6], &[0.0; 6]), ("gravity", &[1, 3], &[0.0; 3])]);
    wrong(&["ur5", "mass-matrix", "--in", &states, "--gravity", "0,0,0"], "--gravity has no effect on mass-matrix");
    wrong(
        &["ur5", "gravity-forces", "--in", &states, "--gravity", "0,0,0"],
        "states.npz are both given, expected one of them",
    );
}

#[test]
fn a_frame_of_a_table_needs_its_wrench() {
    let folder = folder("compute_frame");
    let theta = npz(&folder, "theta.npz", &[("theta", &[1, 6], &[0.0; 6])]);
    wrong(&["ur5", "inverse-dynamics", "--in", &theta, "--frame", "forearm_link"], "--frame has no effect: ");
}

#[test]
fn wrenches_have_a_frame_and_six_numbers() {
    let of = |flags: &[&str], expected| wrong(&[&["ur5", "inverse-dynamics"], flags].concat(), expected);
    of(&["--wrench", "0,0,0,0,0,1"], "--wrench is `0,0,0,0,0,1`, expected FRAME=mx,my,mz,fx,fy,fz");
    of(&["--wrench", "tool0=0,0,0,0,1"], "--wrench tool0 has 5 entries, expected 6: m_x");
    of(&["--wrench", "hand=0,0,0,0,0,1"], "there is no frame `hand`");
    let twice = ["--wrench", "tool0=0,0,0,0,0,1", "--tip-wrench", "0,0,0,0,0,1"];
    of(&twice, "the wrench of the frame `tool0` is given twice");
    let folder = folder("compute_wrenches");
    let states = npz(&folder, "states.npz", &[("theta", &[1, 6], &[0.0; 6]), ("wrench", &[1, 6], &[0.0; 6])]);
    of(&["--in", &states, "--wrench", "tool0=0,0,0,0,0,1"], "the wrench of the frame `tool0` is given twice");
}

#[test]
fn quantities_have_the_names_that_people_know() {
    let theta = "--theta=0.1,-1,1.2,0.3,-0.4,0.5";
    for (alias, name) in
        [("M", "mass-matrix"), ("crba", "mass_matrix"), ("g", "gravity-forces"), ("fk", "forward-kinematics")]
    {
        let of = |name: &str| text(&["compute", "ur5", name, theta, "--json"]);
        assert_eq!(of(alias), of(name), "{alias}");
    }
    let of = |flags: [&str; 2]| text(&["compute", "ur5", "rnea", flags[0], "--json", flags[1]]);
    let degrees = of(["--q=90deg,-pi/4,0,0,0,0", "--gravity=1.62"]);
    let radians = of(["--theta=1.5707963267948966,-0.7853981633974483,0,0,0,0", "--gravity=moon"]);
    assert_eq!(degrees, radians);
}

#[test]
fn an_unknown_quantity_names_what_is_near() {
    let (code, message) = complaint(&["compute", "ur5", "mass-matrx"]);
    assert_eq!(code, 2, "{message}");
    for words in ["`mass-matrx`", "the nearest of 57 are `mass-matrix`", "`mozzi compute --list` shows all"] {
        assert!(message.contains(words), "{words} in {message}");
    }
    assert!(message.lines().count() < 12, "{message}");
    wrong(&["anymal", "body-jacobian"], "the end effector must be named");
    wrong(&["ur5", "task-space-dynamics", "--task", "vw"], "--task: there is no row `vw`");
    wrong(&["ur5", "momentum", "--about", "1,2"], "--about has 2 entries, expected 3: x, y, z");
}
