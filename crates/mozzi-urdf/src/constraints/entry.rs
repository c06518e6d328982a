//! Reads a constraint from an entry of JSON or YAML.

use crate::report::spelling::did_you_mean;
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind};
use mozzi::{SE3, SO3, Vec3};

/// A value of a file and its place: the interface to JSON or YAML that a reader of constraints needs.
pub trait Entry: Sized {
    /// Why a file is refused, with the place.
    type Error;
    /// The value of a key; a null if there is no such key.
    fn get(&self, key: &'static str) -> Self;
    /// The keys of a map; none for any other value.
    fn keys(&self) -> Vec<String>;
    /// Whether it is null.
    fn is_null(&self) -> bool;
    /// Whether it is a map.
    fn is_map(&self) -> bool;
    /// Its place in the file, such as `constraints[1].a`.
    fn name(&self) -> String;
    /// The value as a text.
    ///
    /// # Errors
    /// The value is not a text.
    fn text(&self) -> Result<String, Self::Error>;
    /// The value as a number.
    ///
    /// # Errors
    /// The value is not a number.
    fn number(&self) -> Result<f64, Self::Error>;
    /// The entries of a list.
    ///
    /// # Errors
    /// The value is not a list.
    fn list(&self) -> Result<Vec<Self>, Self::Error>;
    /// An error at its place: "… is …, expected …".
    ///
    /// # Errors
    /// Always.
    fn wrong<T>(&self, expected: &str) -> Result<T, Self::Error>;
    /// An error at its place.
    ///
    /// # Errors
    /// Always.
    fn error<T>(&self, message: String) -> Result<T, Self::Error>;
}

const KINDS: [&str; 6] = ["point", "weld", "hinge", "distance", "rolling", "joint"];
const JOINT: [&str; 5] = ["name", "kind", "joint", "source", "polynomial"];
const ANCHOR: [&str; 4] = ["frame", "xyz", "rpy", "T"];

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
pub fn constraint<E: Entry>(at: &E) -> Result<Constraint, E::Error> {
    if !at.is_map() {
        return at.wrong("a constraint, such as {\"name\": …, \"kind\": \"point\", \"a\": …, \"b\": …}");
    }
    let kind = required(at, "kind")?.text()?;
    let Some(kind) = KINDS.into_iter().find(|known| *known == kind) else {
        return at.get("kind").wrong("one of point, weld, hinge, distance, rolling, joint");
    };
    if kind == "joint" {
        known(at, &JOINT)?;
        let name = required(at, "name")?.text()?;
        let source = at.get("source");
        let source = if source.is_null() { None } else { Some(source.text()?) };
        let (joint, kind) = (required(at, "joint")?.text()?, required(at, "polynomial")?);
        let most = if source.is_some() { 5 } else { 1 };
        let given = numbers(&kind)?;
        // written files have five coefficients; without a source all but the first are zero
        if given.is_empty() || given.len() > 5 || given.iter().skip(most).any(|c| *c != 0.0) {
            return kind.wrong(if most == 5 {
                "one to five coefficients"
            } else {
                "one number, for there is no source"
            });
        }
        let mut polynomial = [0.0; 5];
        polynomial[..given.len()].copy_from_slice(&given);
        return Ok(Constraint { name, kind: ConstraintKind::Joint { joint, source, polynomial } });
    }
    let length = length_key(kind);
    known(at, &["name", "kind", "a", "b"].into_iter().chain(length).collect::<Vec<_>>())?;
    let name = required(at, "name")?.text()?;
    let length = length.map(|key| required(at, key)?.number()).transpose()?.unwrap_or_default();
    let closure = match kind {
        "point" => Closure::Point,
        "weld" => Closure::Weld,
        "hinge" => Closure::Hinge,
        "distance" => Closure::Distance(length),
        _ => Closure::Rolling(length),
    };
    Ok(Constraint::new(name, anchor(&required(at, "a")?)?, anchor(&required(at, "b")?)?, closure))
}

/// A list of names, or null.
///
/// # Errors
/// Another value.
pub fn motors<E: Entry>(at: &E) -> Result<Option<Vec<String>>, E::Error> {
    if at.is_null() { Ok(None) } else { at.list()?.iter().map(E::text).collect::<Result<_, _>>().map(Some) }
}

fn anchor<E: Entry>(at: &E) -> Result<Anchor, E::Error> {
    if !at.is_map() {
        return at.wrong("an anchor, such as {\"frame\": \"hand\", \"xyz\": [0, 0, 0.1]}");
    }
    known(at, &ANCHOR)?;
    let keys = at.keys();
    let has = |key: &str| keys.iter().any(|known| known == key);
    if !has("frame") {
        return at.error(format!("`frame` is missing in {}; null is the space frame", at.name()));
    }
    let frame = at.get("frame");
    let frame = if frame.is_null() { None } else { Some(frame.text()?) };
    if has("T") && (has("xyz") || has("rpy")) {
        return at.get("T").error(format!("{} has both `T` and `xyz` or `rpy`, expected one of them", at.name()));
    }
    let T = if has("T") {
        let at = at.get("T");
        let rows = at.list()?.iter().map(vector::<E, 4>).collect::<Result<Vec<_>, _>>()?;
        let Ok(rows) = <[[f64; 4]; 4]>::try_from(rows) else { return at.wrong("4 rows") };
        match SE3::from_matrix(rows) {
            Ok(T) => T,
            Err(why) => return at.error(format!("{} is not a configuration: {why}", at.name())),
        }
    } else {
        let three = |key| {
            let at = at.get(key);
            if at.is_null() { Ok([0.0; 3]) } else { vector::<E, 3>(&at) }
        };
        let ([roll, pitch, yaw], p) = (three("rpy")?, three("xyz")?);
        SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(p) }
    };
    Ok(Anchor { frame, T })
}

fn numbers<E: Entry>(at: &E) -> Result<Vec<f64>, E::Error> {
    at.list()?.iter().map(E::number).collect()
}

fn vector<E: Entry, const N: usize>(at: &E) -> Result<[f64; N], E::Error> {
    match numbers(at)?.try_into() {
        Ok(vector) => Ok(vector),
        Err(_) => at.wrong(&format!("{N} numbers")),
    }
}

/// The value of a required key.
pub(super) fn required<E: Entry>(at: &E, key: &'static str) -> Result<E, E::Error> {
    if at.keys().iter().any(|known| known == key) {
        return Ok(at.get(key));
    }
    at.error(format!("`{key}` is missing in {}", at.name()))
}

/// Refuses an unknown key.
pub(super) fn known<E: Entry>(at: &E, words: &[&'static str]) -> Result<(), E::Error> {
    match at.keys().into_iter().find(|key| !words.contains(&key.as_str())) {
        None => Ok(()),
        Some(key) => {
            let hint = did_you_mean(&key, words.iter().copied()).map_or_else(String::new, |hint| format!("; {hint}"));
            let key = crate::urdf::vocabulary::shown(&key);
            at.error(format!(
                "`{key}` is not known in {}, expected {}{hint}",
                at.name(),
                crate::urdf::vocabulary::list(words)
            ))
        }
    }
}
