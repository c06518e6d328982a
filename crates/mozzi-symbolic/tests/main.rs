//! Derivations: the book's equations letter by letter, SymPy's own Lagrangian derivation, one text for one robot.

mod book;
mod bounds;
mod canonical;
mod lagrange;
mod printed;
mod robots;

use mozzi::Model;
use mozzi::quantities::{Of, Query};
use mozzi_symbolic::{Derivation, Error, Options, derive};

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
