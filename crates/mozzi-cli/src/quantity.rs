//! A quantity by its name on the command line.

use crate::failure::Result;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mozzi::Model;
use mozzi::quantities::{LIST, Of, Query};

/// Any quantity of the list, with `-` or `_` between its words.
pub fn quantity() -> impl TypedValueParser<Value = Query<'static>> {
    let value = |name: &'static str| PossibleValue::new(hyphenated(name)).alias(name);
    let values = LIST.iter().map(move |declared| value(declared.name).help(declared.formula));
    PossibleValuesParser::new(values).try_map(|name| Query::named(&name))
}

/// A quantity's name as the command line shows it: "mass-matrix".
pub fn hyphenated(name: &str) -> String {
    name.replace('_', "-")
}

/// Does the quantity refer to a frame?
pub fn is_of_a_frame(query: Query) -> bool {
    matches!(query.declaration().of, Of::Frame | Of::Task)
}

/// The quantity; if it refers to a frame, the end effector's.
pub fn of_end_effector<'q>(query: Query<'q>, model: &Model) -> Result<Query<'q>> {
    Ok(if is_of_a_frame(query) { query.of(model.end_effector()?) } else { query })
}
