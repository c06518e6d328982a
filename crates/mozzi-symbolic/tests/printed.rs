//! The other forms: LaTeX with matching braces, Python that computes, long robots in time.

use crate::robots::all;
use crate::{embedded, of};
use mozzi_symbolic::{Language, Options, Symbols};
use pulldown_latex::{Parser, Storage};
use std::process::Command;
use std::time::Instant;

fn options(symbols: Symbols, names: bool) -> Options {
    Options { symbols, names, ..Options::default() }
}

/// A typesetter of its own reads every formula; TeX does, too, but is large.
#[test]
fn latex_is_typeset() {
    let mut count = 0;
    let mut check = |robot: &str, text: &str, quantity: &str, options: &Options| {
        let page = of(text, quantity, options).print(Language::Latex);
        assert!(page.is_ascii(), "{page}");
        for piece in page.split(r"\[").skip(1) {
            let (formula, _) = piece.split_once(r"\]").expect("closed");
            let storage = Storage::new();
            for event in Parser::new(formula, &storage) {
                event.unwrap_or_else(|error| panic!("{robot} {quantity}: {error}\n{formula}"));
            }
            count += 1;
        }
    };
    for (name, text) in all() {
        for quantity in ["M", "C", "c", "g", "tau", "T", "J_b", "kinetic_energy", "M_inv"] {
            check(name, &text, quantity, &options(Symbols::ALL, true));
        }
    }
    for quantity in ["M", "g", "J_b", "J_s"] {
        check("ur5", embedded("ur5"), quantity, &options(Symbols::NONE, true));
    }
    assert!(count > 85, "{count} formulas");
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
