//! `mozzi compare`: its messages if Python or the file is wrong, and a run with the real libraries if they are
//! installed.
#![allow(clippy::unwrap_used)]

use crate::common;

#[cfg(unix)]
use common::script;
use common::{complaint, file, folder, mozzi};
use serde_json::Value;

const PEERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/peers");

fn says(arguments: &[&str], words: &[&str]) {
    let (code, message) = complaint(arguments);
    assert_eq!(code, 1, "{message}");
    assert!(words.iter().all(|word| message.contains(word)) && !message.contains("panicked"), "{message}");
}

#[test]
fn without_python_or_a_file() {
    says(&["compare", "ur5", "--python", "no/such/python"], &["`no/such/python` did not start", "--python"]);
    says(&["compare", "nowhere.urdf"], &["`nowhere.urdf` is neither a file"]);
    assert_eq!(complaint(&["compare", "ur5", "--states", "0"]).0, 2);
}

#[cfg(unix)]
#[test]
fn a_python_that_gives_no_answer() {
    let dies = script("fake_dies", "cat > /dev/null; echo 'cannot go on' >&2; exit 3");
    says(&["compare", "ur5", "--python", &dies], &["no library to compare with", "exit status: 3: cannot go on"]);
    let quits = script("fake_quits", "exit 0");
    says(&["compare", "ur5", "--python", &quits], &["is not what the script writes: ``"]);
    let chats = script("fake_chats", "cat > /dev/null; echo hello");
    says(&["compare", "ur5", "--python", &chats], &["is not what the script writes: `hello"]);
    let bare = script(
        "fake_bare",
        r#"cat > /dev/null; echo '{"library": "mujoco", "version": null, "attempts": [], "error": {"stage": "import", "message": "No module named x"}}'"#,
    );
    let hangs = script("fake_hangs", "exec sleep 1000");
    says(
        &["compare", "ur5", "--python", &hangs, "--time-limit", "0.5"],
        &["no answer within 0.5 s, it was ended", "the program called as Python"],
    );
    says(&["compare", "ur5", "--time-limit", "0"], &["--time-limit is 0 s, expected more than 0"]);
    let crashes = script("fake_crashes", "cat > /dev/null; kill -SEGV $$");
    says(&["compare", "ur5", "--python", &crashes], &["MuJoCo returned no result", "the fault is MuJoCo's"]);
    let computes = script(
        "fake_computes",
        r#"if grep -q '"library":"mujoco"'; then echo '{"library": "mujoco", "version": "9", "attempts": [], "error": {"stage": "compute", "message": "IndexError: too far", "fault": "mozzi"}}'; else echo '{"library": "pinocchio", "version": "9", "attempts": [], "error": {"stage": "load", "message": "too red"}}'; fi"#,
    );
    let report: Value =
        serde_json::from_slice(&mozzi(&["compare", "ur5", "--python", &computes, "--json"]).stdout).unwrap();
    let of = |k: usize, key: &str| report["libraries"][k][key].as_str().map(str::to_string);
    assert_eq!((of(0, "status"), of(0, "fault")), (Some("refused".into()), None), "{report}");
    assert_eq!((of(1, "status"), of(1, "fault")), (Some("no answer".into()), Some("mozzi".into())), "{report}");
    says(
        &["compare", "ur5", "--python", &bare],
        &["MuJoCo is not installed (No module named x); `pip install pin mujoco`", "--python names another Python"],
    );
    let refuses = script(
        "fake_refuses",
        r#"cat > /dev/null; echo '{"library": "mujoco", "version": "9", "attempts": [], "error": {"stage": "load", "message": "too red"}}'"#,
    );
    let output = mozzi(&["compare", "ur5", "--python", &refuses]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "nothing was compared");
    assert!(text.contains("MuJoCo 9: refuses the file: too red"), "{text}");
}

/// The Python of `cargo xtask test`; without it, or without the libraries, the test is skipped.
fn python() -> Option<String> {
    let python = std::env::var("MOZZI_PYTHON").ok()?;
    let mut import = std::process::Command::new(&python);
    let has = import.args(["-c", "import pinocchio, mujoco"]).output().is_ok_and(|output| output.status.success());
    has.then_some(python)
}

#[test]
fn with_the_real_libraries() {
    let Some(python) = python() else {
        println!("skipped: MOZZI_PYTHON names no Python with pin and mujoco (cargo xtask test makes one)");
        return;
    };
    let run = |model: &str| {
        let output = mozzi(&["compare", model, "--python", &python, "--json", "--states", "4", "--seed", "7"]);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        (output.status.code().unwrap(), report)
    };
    let status = |report: &Value, k: usize| report["libraries"][k]["status"].as_str().unwrap().to_string();
    let (code, report) = run("ur5");
    assert_eq!((code, status(&report, 0), status(&report, 1)), (0, "agrees".into(), "agrees".into()), "{report}");
    for (model, kinds) in [("doctor.urdf", 3), ("springs.xml", 3)] {
        let (code, report) = run(&format!("{PEERS}/{model}"));
        assert_eq!((code, status(&report, 0), status(&report, 1)), (0, "explained".into(), "explained".into()));
        assert_eq!(report["libraries"][0]["comparison"]["causes"].as_array().unwrap().len(), kinds, "{report}");
    }
    // with one joint, Pinocchio's Jacobian is a vector
    for kind in ["revolute", "continuous", "prismatic"] {
        let one = format!(
            "<robot name='one'><link name='a'/><link name='b'><inertial><origin xyz='0.4 0.1 0'/><mass value='3'/>\
             <inertia ixx='0.2' iyy='0.3' izz='0.4' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' type='{kind}'>\
             <parent link='a'/><child link='b'/><axis xyz='0 -1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>"
        );
        let (code, report) = run(&file(&folder(&format!("one_{kind}")), "one.urdf", &one));
        assert_eq!((code, status(&report, 0), status(&report, 1)), (0, "agrees".into(), "agrees".into()), "{report}");
    }
    let (code, report) = run(&format!("{PEERS}/floating.urdf"));
    assert_eq!((code, status(&report, 0), status(&report, 1)), (0, "agrees".into(), "agrees".into()), "{report}");
    // JSON is passed to the libraries as URDF; a file that mozzi refuses is still passed to them
    let folder = folder("compare");
    let json = folder.join("ur5.json").to_str().unwrap().to_string();
    common::text(&["convert", "ur5", &json]);
    assert_eq!(run(&json).0, 0);
    let refused = file(&folder, "two.urdf", "<robot name='two'><link name='a'/><link name='b'/></robot>");
    let (code, report) = run(&refused);
    assert_eq!((code, &report["refused"]), (1, &Value::Bool(true)), "{report}");
}

#[test]
fn a_base_that_is_freed_is_free_in_the_libraries() {
    // the libraries get a floating base, too; a spatial robot with a free-floating base
    let Some(python) = python() else {
        says(&["compare", "ur5", "--floating", "--python", "no/such/python"], &["did not start"]);
        return;
    };
    let report = common::text(&["compare", "ur5", "--floating", "--python", &python, "--states", "3"]);
    assert!(report.contains("ur5: a floating base"), "{report}");
}

#[test]
fn two_files_are_compared_without_python() {
    let faults = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/faults");
    let path = |name: &str| format!("{faults}/{name}");
    let (before, after) = (path("before.urdf"), path("02_not_rotated.urdf"));
    let output = mozzi(&["compare", &before, &after]);
    let report = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{report}");
    assert!(report.contains("02_not_rotated.urdf's inertia of `upper` is not rotated"), "{report}");
    assert!(report.contains("torque of `shoulder` differs by up to") && report.contains("N m"), "{report}");
    assert_eq!(mozzi(&["compare", &before, &after, "--tolerance", "0.9"]).status.code(), Some(0));
    assert_eq!(mozzi(&["compare", &before, &before]).status.code(), Some(0));
    says(&["compare", &before, &after, "--tolerance", "2"], &["--tolerance is 2, expected a number from 0 to 1"]);
    says(&["compare", &before, "nowhere.sdf"], &["`nowhere.sdf` is neither a file"]);
    assert_eq!(complaint(&["compare", &before, "--tolerance", "1e-3"]).0, 2);
}

#[test]
fn two_files_that_start_elsewhere() {
    let folder = folder("compare_starts");
    let mjcf = |reference: &str| {
        format!(
            "<mujoco model='m'><worldbody><body name='arm'><joint name='j' axis='0 1 0' {reference}/>\
             <geom size='0.1' mass='1'/><site name='tcp' pos='0.1 0 0'/></body></worldbody></mujoco>"
        )
    };
    let (a, b) = (file(&folder, "a.xml", &mjcf("")), file(&folder, "b.xml", &mjcf("ref='40'")));
    let run = |a: &str, b: &str| {
        let output = mozzi(&["compare", a, b]);
        let text = String::from_utf8(output.stdout).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
        (output.status.code().unwrap(), text)
    };
    let (code, text) = run(&a, &b);
    assert!(code == 1 && text.contains("the robot starts elsewhere in b.xml: `j` 0.698132 instead of 0"), "{text}");
    assert_eq!(run(&b, &b).0, 0);
    // JSON has the start, URDF cannot have it
    let [json, urdf] = ["b.json", "b.urdf"].map(|name| folder.join(name).to_str().unwrap().to_string());
    common::text(&["convert", &b, &json]);
    common::text(&["convert", &b, &urdf]);
    let (code, text) = run(&b, &json);
    assert!(code == 0 && !text.contains("only"), "{text}");
    assert_eq!(run(&a, &json).0, 1);
    let (code, text) = run(&b, &urdf);
    assert!(code == 0 && text.contains("note: state of b.xml only: `qpos0`"), "{text}");
}
