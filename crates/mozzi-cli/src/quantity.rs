//! A quantity by its name on the command line.

use crate::failure::Result;
use clap::builder::{PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use mozzi::Model;
use mozzi::quantities::{ALIASES, LIST, Query};
use std::ffi::OsStr;

/// Any quantity of the list, with `-` or `_` between its words, or by an alias.
pub fn quantity() -> impl TypedValueParser<Value = Query<'static>> {
    Names
}

/// Names that are mistaken for quantities, with the command that computes them.
const ELSEWHERE: [(&str, &str); 8] = [
    ("closed", "`mozzi terms MODEL --stacked` shows the closed form"),
    ("newton", "`mozzi terms MODEL --all` shows the Newton-Euler recursion"),
    ("ik", "`mozzi ik MODEL --position X,Y,Z` is inverse kinematics"),
    ("inverse_kinematics", "`mozzi ik MODEL --position X,Y,Z` is inverse kinematics"),
    ("all", "`mozzi terms MODEL` computes all quantities at one state"),
    ("screw", "`mozzi screws MODEL` shows the screw axes"),
    ("G", "`mozzi screws MODEL` shows the spatial inertias G_i"),
    ("energy", "its parts: `mozzi compute MODEL kinetic-energy,potential-energy`"),
];

/// Such names that begin others, as `velocity` begins `velocity_product`.
const ALONE: [(&str, &str); 7] = [
    ("manipulability", MANIPULABILITY),
    ("manipulability_ellipsoid", MANIPULABILITY),
    ("twist", TWIST),
    ("velocity", TWIST),
    ("acceleration", ACCELERATION),
    ("classical_acceleration", ACCELERATION),
    ("gravity_compensation", GRAVITY_COMPENSATION),
];
const MANIPULABILITY: &str =
    "`mozzi plot ellipsoids MODEL --out FILE.svg` draws the ellipsoids, `mozzi compute MODEL J_b` has the Jacobian";
const TWIST: &str = "a frame's twist is J θ̇ with `body-jacobian` or `space-jacobian`, (ω, v)";
const ACCELERATION: &str =
    "`frame-acceleration` is a frame's, `forward-dynamics` has the joints', `center-of-mass-acceleration` the robot's";
const GRAVITY_COMPENSATION: &str =
    "`gravity-forces` is g(θ), without springs; `mozzi simulate MODEL --torque gravity-compensation` applies both";

/// The command for a name that is not a quantity.
pub fn elsewhere(name: &str) -> Option<&'static str> {
    let plain = name.replace('-', "_");
    if let Some((_, tip)) = ALONE.iter().find(|(known, _)| plain == *known) {
        return Some(tip);
    }
    let is_meant = |known: &str| plain == known || known.len() > 3 && plain.starts_with(known);
    ELSEWHERE.iter().find(|(known, _)| is_meant(known)).map(|(_, tip)| *tip)
}

/// The names of quantities; the error for an unknown one lists the nearest, not all.
#[derive(Clone)]
struct Names;

impl TypedValueParser for Names {
    type Value = Query<'static>;

    fn parse_ref(
        &self,
        command: &clap::Command,
        _argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> std::result::Result<Query<'static>, clap::Error> {
        let name = value.to_string_lossy();
        Query::named(&name).map_err(|error| {
            if name.parse::<f64>().is_ok() {
                let tip = format!("the numbers of a list are separated by commas: --theta 0.1,{name}");
                let said = format!("there is no quantity `{name}`\n\n  tip: {tip}");
                return command.clone().error(ErrorKind::InvalidValue, said);
            }
            let tip = elsewhere(&name).map_or_else(String::new, |tip| format!("\n\n  tip: {tip}"));
            // the nearest names as they are typed here, the given one as it is
            let told = error.to_string();
            let (before, near) = told.split_once("the nearest").unwrap_or((&told, ""));
            let near = if near.is_empty() { String::new() } else { format!("the nearest{}", hyphenated(near)) };
            let told = format!("{before}{near}");
            let list = "`mozzi compute --list` shows all; M, C, c, g, h, J_b, J_s, rnea, crba, aba, fk are known, too";
            command.clone().error(ErrorKind::InvalidValue, format!("{told}{tip}\n\n  tip: {list}"))
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

/// The quantity; if it refers to a frame, the end effector's.
pub fn of_end_effector<'q>(query: Query<'q>, model: &Model) -> Result<Query<'q>> {
    Ok(if query.declaration().needs_frame() { query.of(model.end_effector()?) } else { query })
}
