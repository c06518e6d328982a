//! Derivations: the book's equations letter by letter, SymPy's own Lagrangian derivation, one text for one robot.

mod base_parameters;
mod book;
mod bounds;
mod canonical;
mod inverse;
mod lagrange;
mod numbers;
mod printed;
mod published;
mod robots;

use mozzi::Model;
use mozzi::quantities::{Of, Query};
use mozzi_symbolic::{Derivation, Error, Language, Options, derive};

/// The model of a URDF text.
pub fn model(text: &str) -> Model {
    mozzi_urdf::parse("robot.urdf", text).expect("sound").description.build().expect("sound")
}

/// A quantity of a URDF text; the end effector's, if it is of a frame.
pub fn attempt(text: &str, quantity: &str, options: &Options) -> Result<Derivation, Error> {
    let model = model(text);
    let mut query = Query::named(quantity).expect(quantity);
    if query.declaration().of == Of::Frame {
        query = query.of(model.end_effector().expect("one"));
    }
    derive(&model, Some(text), query, options)
}

/// As [`attempt`], which succeeds.
pub fn of(text: &str, quantity: &str, options: &Options) -> Derivation {
    attempt(text, quantity, options).unwrap_or_else(|error| panic!("{quantity}: {error}"))
}

/// The text of an embedded robot.
pub fn embedded(robot: &str) -> &'static str {
    mozzi_urdf::embedded::text(robot).expect(robot)
}

/// The lines of a page without its legend, spaces made single.
pub fn formulas(derivation: &Derivation) -> String {
    let text = derivation.print(Language::Text).replace("\n    ", " "); // broken lines
    let formulas = text.split("\n\n").next().expect("formulas");
    let squeezed = |line: &str| line.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
    formulas.trim().lines().map(squeezed).collect::<Vec<_>>().join("\n")
}
