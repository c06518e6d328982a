//! Reads a constraint from an entry of JSON or YAML.

use crate::json::{At, GEAR, Misplaced, Object, Read, gear};
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, Gear};
use mozzi::{SE3, SO3, Vec3};

const FRAMES: [&str; 4] = ["name", "kind", "a", "b"];
const KINDS: [(&str, Object); 6] = [
    ("point", Object::of(&FRAMES)),
    ("weld", Object::of(&FRAMES)),
    ("hinge", Object::of(&FRAMES)),
    ("distance", Object::of(&["name", "kind", "a", "b", "length"])),
    ("rolling", Object::of(&["name", "kind", "a", "b", "radius"])),
    ("joint", Object::of(&["name", "kind", "joint", "polynomial"]).optional(&["source"])),
];
const ANCHOR: Object = Object::of(&["frame"]).optional(&["xyz", "rpy", "T"]);

/// The key of the length that belongs to a kind.
pub(super) fn length_key(kind: &str) -> Option<&'static str> {
    match kind {
        "distance" => Some("length"),
        "rolling" => Some("radius"),
        _ => None,
    }
}

/// A constraint in mozzi's format: see [the module](super).
///
/// # Errors
/// An unknown or missing key; a value of another type; a matrix that is not a configuration.
pub fn constraint(at: &At) -> Read<Constraint> {
    if !at.value.is_object() {
        return at.wrong("a constraint, such as {\"name\": …, \"kind\": \"point\", \"a\": …, \"b\": …}");
    }
    Object::of(&["kind"]).check_required(at).map_err(first)?;
    let kind = at.get("kind").word(&KINDS.map(|(kind, _)| kind))?;
    KINDS.iter().filter(|(known, _)| *known == kind).try_for_each(|(_, object)| check(object, at))?;
    let name = at.get("name").text()?;
    if kind == "joint" {
        let source = at.get("source").some(sum)?.unwrap_or_default();
        let coefficients = at.get("polynomial");
        let most = if source.is_empty() { 1 } else { 5 };
        let given = coefficients.numbers()?;
        // written files have five coefficients; without a source all but the first are zero
        if given.is_empty() || given.len() > 5 || given.iter().skip(most).any(|c| *c != 0.0) {
            return coefficients.wrong(if most == 5 {
                "one to five coefficients"
            } else {
                "one number, for there is no source"
            });
        }
        let mut polynomial = [0.0; 5];
        polynomial[..given.len()].copy_from_slice(&given);
        return Ok(Constraint {
            name,
            kind: ConstraintKind::Joint { joints: sum(&at.get("joint"))?, source, polynomial },
        });
    }
    let length = length_key(kind).map(|key| at.get(key).number()).transpose()?.unwrap_or_default();
    let closure = match kind {
        "point" => Closure::Point,
        "weld" => Closure::Weld,
        "hinge" => Closure::Hinge,
        "distance" => Closure::Distance(length),
        _ => Closure::Rolling(length),
    };
    Ok(Constraint::new(name, anchor(&at.get("a"))?, anchor(&at.get("b"))?, closure))
}

/// A joint, or several with their ratios.
fn sum(at: &At) -> Read<Vec<Gear>> {
    match at.list() {
        Err(_) if at.value.is_string() => Ok(vec![Gear { joint: at.text()?, ratio: 1.0 }]),
        Ok(list) if !list.is_empty() => {
            list.iter().try_for_each(|entry| check(&GEAR, entry))?;
            list.iter().map(gear).collect()
        }
        _ => at.wrong("a joint, or a list of joints such as [{\"joint\": \"elbow\", \"ratio\": 0.5}]"),
    }
}

fn anchor(at: &At) -> Read<Anchor> {
    if !at.value.is_object() {
        return at.wrong("an anchor, such as {\"frame\": \"hand\", \"xyz\": [0, 0, 0.1]}");
    }
    if !at.has("frame") {
        return at.error(format_args!("`frame` is missing in {}; null is the space frame", at.name()));
    }
    check(&ANCHOR, at)?;
    if at.has("T") && (at.has("xyz") || at.has("rpy")) {
        return at.get("T").error(format_args!("{} has both `T` and `xyz` or `rpy`, expected one of them", at.name()));
    }
    let T = if at.has("T") {
        at.get("T").pose()?
    } else {
        let three = |key| Read::Ok(at.get(key).some(At::vector)?.unwrap_or_default());
        let ([roll, pitch, yaw], p) = (three("rpy")?, three("xyz")?);
        SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(p) }
    };
    Ok(Anchor { frame: at.get("frame").some(At::text)?, T })
}

/// The first error about the keys of an object.
pub(super) fn check(object: &Object, at: &At) -> Read<()> {
    object.check_all(at).map_err(first)
}

/// There is at least one where an object is refused.
fn first(mut errors: Vec<Misplaced>) -> Misplaced {
    errors.swap_remove(0)
}
