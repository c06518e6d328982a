//! SymPy derives the same equations from the same files, by Lagrange's equations.

use crate::of;
use crate::robots::all;
use mozzi_symbolic::{Language, Options, Symbols};
use std::path::Path;
use std::process::Command;

const SYMBOLS: Options = Options {
    symbols: Symbols::ALL,
    equal: mozzi_symbolic::Equal::Separate,
    collect: mozzi_symbolic::Collect::Shortest,
    names: false,
};

/// The Python with SymPy, if there is one.
pub fn python() -> Option<String> {
    let python = std::env::var("MOZZI_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python).args(["-c", "import sympy"]).output().is_ok_and(|output| output.status.success());
    if !has {
        println!("skipped: there is no Python with SymPy; MOZZI_PYTHON names one");
    }
    has.then_some(python)
}

#[test]
fn sympy_derives_the_same() {
    let Some(python) = python() else { return };
    let folder = std::env::temp_dir().join(format!("mozzi-lagrange-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lagrange.py");
    for (name, text) in all() {
        let write = |file: &str, text: &str| {
            let path = folder.join(file);
            std::fs::write(&path, text).expect("written");
            path
        };
        let mut command = Command::new(&python);
        command.arg(&script).arg(write("robot.urdf", &text));
        for quantity in ["mass_matrix", "velocity_product", "gravity_forces"] {
            let module = of(&text, quantity, &SYMBOLS).print(Language::Sympy);
            command.arg(write(&format!("{quantity}.py"), &module));
        }
        let output = command.output().expect("Python runs");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(said.starts_with("equal"), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}
