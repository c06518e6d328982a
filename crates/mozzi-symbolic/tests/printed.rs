//! The other forms: LaTeX with matching braces, Python that computes, long robots in time.

use crate::{embedded, of};
use mozzi_symbolic::{Language, Options, Symbols};
use std::process::Command;
use std::time::Instant;

fn options(symbols: Symbols, names: bool) -> Options {
    Options { symbols, names, ..Options::default() }
}

#[test]
fn latex_has_matching_braces_and_environments() {
    for (robot, quantity) in [("two_link_planar", "tau"), ("furuta_pendulum", "c"), ("ur5", "g"), ("ur5", "J_b")] {
        let names = robot == "ur5";
        let symbols = if names { Symbols::NONE } else { Symbols::ALL };
        let page = of(embedded(robot), quantity, &options(symbols, names)).print(Language::Latex);
        let count = |what: &str| page.matches(what).count();
        assert_eq!(count("{"), count("}"), "{page}");
        assert_eq!(count("("), count(")"), "{page}");
        assert_eq!(count(r"\begin"), count(r"\end"), "{page}");
        assert_eq!(count(r"\["), count(r"\]"), "{page}");
        assert!(page.is_ascii(), "{page}");
    }
}

#[test]
fn python_computes_what_the_kernel_computes() {
    let python = std::env::var("MOZZI_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python).args(["-c", "import numpy"]).output().is_ok_and(|output| output.status.success());
    if !has {
        println!("skipped: there is no Python with NumPy; MOZZI_PYTHON names one");
        return;
    }
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let model = crate::model(embedded("ur5"));
    for names in [false, true] {
        let mut script = of(embedded("ur5"), "M", &options(Symbols::NONE, names)).print(Language::Python);
        script.push_str(&format!("print(*mass_matrix({theta:?}).ravel())\n"));
        let output = Command::new(&python).args(["-c", &script]).output().expect("Python runs");
        let said = String::from_utf8_lossy(&output.stdout);
        let found: Vec<f64> = said.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        let expected = model.mass_matrix(&theta).expect("regular");
        assert_eq!(found.len(), 36, "{}", String::from_utf8_lossy(&output.stderr));
        for (k, x) in found.iter().enumerate() {
            assert!((x - expected[(k / 6, k % 6)]).abs() < 1e-7 * expected.amax(), "{k}: {x}");
        }
    }
}

/// An arm's M and g take less than two seconds where the test is compiled with little optimization, too.
#[test]
fn arms_are_derived_soon() {
    for (robot, quantity, seconds) in [("ur5", "M", 2.0), ("panda", "g", 2.0)] {
        let best = (0..3)
            .map(|_| {
                let start = Instant::now();
                of(embedded(robot), quantity, &options(Symbols::NONE, true));
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!("{robot} {quantity}: {best:.2} s");
        assert!(best < 4.0 * seconds, "{robot} {quantity}: {best} s");
    }
}

#[test]
fn angles_of_the_file_are_exact() {
    let found = of(embedded("ur5"), "T", &options(Symbols::NONE, false));
    let page = found.print(Language::Text);
    assert!(page.contains("read as multiples of π"), "{page}");
}
