//! A quantity by its name on the command line.

use crate::failure::Result;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue};
use mozzi::Model;
use mozzi::quantities::{ALIASES, LIST, Of, Query};
use std::ffi::OsStr;

/// Any quantity of the list, with `-` or `_` between its words, or by an alias.
pub fn quantity() -> impl TypedValueParser<Value = Query<'static>> {
    Names.try_map(|name| Query::named(&name))
}

/// The names of quantities; an unknown one is answered by the nearest, not by all.
#[derive(Clone)]
struct Names;

impl TypedValueParser for Names {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> std::result::Result<String, clap::Error> {
        PossibleValuesParser::new(values()).parse_ref(command, argument, value).map_err(|mut error| {
            error.remove(ContextKind::ValidValue);
            let tip = "`mozzi compute --list` shows all quantities; M, C, c, g, h, J_b, rnea, crba, aba and fk are known, too";
            error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
            error
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(values()))
    }
}

fn values() -> impl Iterator<Item = PossibleValue> {
    let aliases = |name: &'static str| ALIASES.iter().filter(move |(_, of)| *of == name).map(|(alias, _)| *alias);
    let value = move |name: &'static str| PossibleValue::new(hyphenated(name)).alias(name).aliases(aliases(name));
    LIST.iter().map(move |declared| value(declared.name).help(declared.formula))
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
