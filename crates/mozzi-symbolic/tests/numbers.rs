//! Robots without a file's decimals: their rotations are exact, so that kernels that divide are equal to fractions, and
//! columns of the regressor depend on each other exactly.

use crate::robots::{Moved, chain, moved};
use crate::{model, of};
use mozzi::quantities::Query;
use mozzi_symbolic::{Language, Options, Symbols, base_parameters, derive};

/// Joints with rotations about one, two and three axes, the last with an axis of no short direction.
fn turned(joints: usize) -> String {
    let inertia = ["0.01", "0.02", "0.025"];
    let links = [
        Moved { rpy: "0.25 0 0", ..moved("prismatic", "1 0 0", "0 0 1", "2", "0.1 0 0", inertia) },
        Moved { rpy: "0.3 -0.7 0", ..moved("continuous", "0 1 0", "0.2 0.1 0", "1.5", "0 0.1 0.2", inertia) },
        Moved { rpy: "0.3 -0.7 1.1", ..moved("continuous", "0.13 0.237 0.97", "0 0 0.3", "0.7", "0 0 0.1", inertia) },
    ];
    chain("turned", &links[..joints])
}

#[test]
fn rotations_of_numbers_are_exact() {
    for symbols in [Symbols::ALL, Symbols::NONE] {
        let options = Options { symbols, ..Options::default() };
        for name in ["mass_matrix_inverse", "forward_dynamics"] {
            let found = derive(&model(&turned(2)), None, Query::named(name).expect(name), &options);
            found.unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        let robot = model(&turned(3));
        let found = base_parameters(&robot, None, &options).expect("derived");
        // those of joints, which follow the bodies', are 0
        let rank = robot.base_parameters().columns.iter().filter(|column| **column < 30).count();
        assert_eq!(found.formulas[0].shape, [rank], "{}", found.print(Language::Text));
    }
}

/// Fractions of many digits are written by sixteen of them, and exactly for SymPy; entries that are 0 remain so.
#[test]
fn long_fractions_are_shortened_in_text() {
    let inertia = ["0.01", "0.02", "0.025"];
    let links = [
        moved("prismatic", "1 0 0", "0 0 1", "2", "0.1 0 0", inertia),
        Moved { rpy: "0.6 -0.25 0", ..moved("continuous", "0 1 0", "0.2 0.1 0", "1.5", "0 0 0.2", inertia) },
    ];
    let text = chain("short", &links);
    let query = Query::named("mass_matrix").expect("M");
    let options = Options { symbols: Symbols::NONE, ..Options::default() };
    let found = derive(&model(&text), None, query, &options).expect("derived");
    let page = found.print(Language::Text);
    assert!(page.contains("… cos θ₂") && !page.contains("0.0000000000"), "{page}");
    let latex = found.print(Language::Latex);
    assert!(latex.contains("\\ldots ") && latex.is_ascii(), "{latex}");
    assert!(found.print(Language::Sympy).contains("Rational("), "exact");
    let of_file = of(&text, "mass_matrix", &options).evaluate(&[&[0.1, 0.4]], |x| x.to_f64(), std::f64::consts::PI);
    let of_numbers = found.evaluate(&[&[0.1, 0.4]], |x| x.to_f64(), std::f64::consts::PI);
    for (x, y) in of_file[0].iter().zip(&of_numbers[0]) {
        assert!((x - y).abs() < 1e-14, "{x} instead of {y}");
    }
}
