//! A file of xacro's is refused with the command that expands it, and what PyPI's xacro 2.1.1 makes of it by that
//! command (`arm.urdf`, beside it) loads without a word.

use mozzi::model::Severity;
use mozzi_urdf::{load, model, open};
use std::path::Path;

fn file(name: &str) -> String {
    Path::new("tests/xacro").join(name).to_string_lossy().replace('\\', "/")
}

#[test]
fn one_error_with_the_command() {
    let error = load(file("arm.urdf.xacro")).expect_err("not expanded");
    let [found] = error.diagnostics() else { panic!("{error}") };
    assert_eq!((found.severity(), found.code()), (Severity::Error, "mozzi::urdf::xacro"));
    assert_eq!(
        found.to_string(),
        "tests/xacro/arm.urdf.xacro:4:4: error: <xacro:arg> is a xacro element, expected a file that xacro has expanded"
    );
    assert_eq!(
        found.help(),
        Some("`pip install xacro; xacro tests/xacro/arm.urdf.xacro > tests/xacro/arm.urdf` expands it")
    );
}

#[test]
fn what_xacro_writes_is_read() {
    let robot = open(&file("arm.urdf")).expect("expanded");
    assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
    let model = model(file("arm.urdf")).expect("a robot");
    assert_eq!(model.n(), 2);
    assert_eq!(robot.description.links[1].inertia.mass, 2.5);
}
