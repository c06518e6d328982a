//! `mozzi compare`: its words where Python or the file is wrong, and a run with the real libraries where they are.
#![allow(clippy::unwrap_used)]

mod common;

use common::{complaint, file, folder, mozzi};
use serde_json::Value;

const PEERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-compare/tests/peers");

/// A program that takes Python's place.
#[cfg(unix)]
fn fake(name: &str, script: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = file(&folder(&format!("fake_{name}")), "python", &format!("#!/bin/sh\n{script}\n"));
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

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
    let dies = fake("dies", "cat > /dev/null; echo 'cannot go on' >&2; exit 3");
    says(&["compare", "ur5", "--python", &dies], &["no library to compare with", "exit status: 3: cannot go on"]);
    let quits = fake("quits", "exit 0");
    says(&["compare", "ur5", "--python", &quits], &["is not what the script writes: ``"]);
    let chats = fake("chats", "cat > /dev/null; echo hello");
    says(&["compare", "ur5", "--python", &chats], &["is not what the script writes: `hello"]);
    let bare = fake(
        "bare",
        r#"cat > /dev/null; echo '{"library": "mujoco", "version": null, "attempts": [], "error": {"stage": "import", "message": "No module named x"}}'"#,
    );
    says(
        &["compare", "ur5", "--python", &bare],
        &["MuJoCo not installed: No module named x", "pip install pin mujoco"],
    );
    let refuses = fake(
        "refuses",
        r#"cat > /dev/null; echo '{"library": "mujoco", "version": "9", "attempts": [], "error": {"stage": "load", "message": "too red"}}'"#,
    );
    let output = mozzi(&["compare", "ur5", "--python", &refuses]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "nothing was compared");
    assert!(text.contains("MuJoCo 9: refuses the file: too red"), "{text}");
}

/// Of `cargo xtask test`; without it, or without the libraries, there is nothing to run.
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
    let (code, report) = run(&format!("{PEERS}/floating.urdf"));
    assert_eq!((code, status(&report, 0), status(&report, 1)), (0, "agrees".into(), "agrees".into()), "{report}");
    // JSON is handed over as URDF; a file that mozzi refuses is shown to the others
    let folder = folder("compare");
    let json = folder.join("ur5.json").to_str().unwrap().to_string();
    common::text(&["convert", "ur5", &json]);
    assert_eq!(run(&json).0, 0);
    let refused = file(&folder, "two.urdf", "<robot name='two'><link name='a'/><link name='b'/></robot>");
    let (code, report) = run(&refused);
    assert_eq!((code, &report["refused"]), (1, &Value::Bool(true)), "{report}");
}

#[test]
fn a_base_that_the_file_bolts_down_is_not_compared_as_free() {
    let (_, message) = common::complaint(&["compare", "ur5", "--floating"]);
    assert!(message.contains("--floating is not for compare: other libraries read the file as it stands"), "{message}");
}
