//! What is printed fits a screen, and rounding errors are 0.

use crate::common::{folder, json, screen, text};

const Q: &str = "--q=0,-1.2,1.5,0.3,1.1,0";

#[test]
fn noise_is_zero() {
    let page = text(&["compute", "double_pendulum", "g", "--q=pi,0"]);
    assert!(!page.contains("e-1"), "{page}");
    let page = text(&["terms", "ur5", Q]);
    assert!(!page.contains("e-1"), "{page}");
    let page = text(&["simulate", "ur5", "--controller", "computed-torque", Q, "--time", "0.05"]);
    assert!(!page.contains("e-1") && !page.contains("e-3"), "{page}");
}

#[test]
fn default_commands_fit_a_screen() {
    screen(&[], 60);
    for command in ["info", "terms", "screws"] {
        for robot in ["ur5", "two_link_planar"] {
            screen(&[command, robot], 60);
        }
        screen(&[command, "panda"], 60);
        screen(&[command, "anymal", "--floating"], 100);
    }
    screen(&["terms", "ur5", Q, "--qd=1,1,1,1,1,1"], 60);
    for quantity in
        ["M", "C", "g", "J_b", "T", "rnea", "com", "regressor", "inverse-dynamics-derivatives", "frame-poses"]
    {
        screen(&["compute", "ur5", quantity], 60);
    }
    screen(&["compute", "anymal", "M", "--floating"], 100);
    screen(&["simulate", "ur5", "--time", "0.05"], 60);
    screen(&["simulate", "anymal", "--floating", "--time", "0.01"], 100);
    screen(&["ik", "ur5", "--position", "0.4,0.2,0.5", "--rpy", "pi,0,0"], 60);
    screen(&["trajectory", "ur5", "--to", "1,-1,1,0,0.5,0"], 60);
    screen(&["bench", "ur5", "--states", "64", "--rounds", "1"], 60);
    // what is left out is named, and there with --all
    let short = screen(&["terms", "ur5"], 60);
    assert!(short.contains("left out: ") && short.contains("--all shows them"), "{short}");
    assert!(text(&["terms", "ur5", "--all"]).contains("Newton-Euler recursion"));
    assert!(text(&["screws", "ur5", "--all"]).contains("G_6, wrist_3_link"));
    let state = "positions";
    assert!(!text(&["compute", "ur5", "M"]).contains(state) && text(&["compute", "ur5", "M", "-v"]).contains(state));
}

#[test]
fn terms_can_be_picked() {
    let page = screen(&["terms", "ur5", "--only", "M,g", Q], 60);
    assert!(
        page.contains("mass_matrix: ") && page.contains("gravity_forces: ") && !page.contains("Jacobian"),
        "{page}"
    );
    let found = json(&["terms", "ur5", "--only", "g", Q]);
    assert!(found["gravity_forces"].is_array() && found.get("mass_matrix").is_none(), "{found}");
}

#[test]
fn the_tour_writes_a_file_only_if_asked() {
    let folder = folder("first_tour");
    let table = folder.join("fall.csv");
    text(&["--out", table.to_str().expect("text")]);
    assert!(std::fs::read_to_string(&table).expect("a table").starts_with("method,t,theta_1"));
}
