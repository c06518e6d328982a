//! `<keyframe>`, and `qpos0`: named states, converted to mozzi's coordinates.

use super::coordinates::{Coordinates, Slot};
use super::tree::{Name, Names};
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::places::{Place, Places};
use crate::report::spelling::counted;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::text::number::all_numbers;
use crate::urdf::vocabulary::shown;
use mozzi::Description;
use std::collections::BTreeSet;

/// Largest number of positions in all keys together, to bound memory.
const MOST_POSITIONS: usize = 1_000_000;

/// MuJoCo's initial state.
pub(super) const QPOS0: &str = "qpos0";

/// Tolerance on a mimic joint's number against its source joint's, rad or m, and per second; relative above 1. MuJoCo's
/// solver satisfies a coupling only approximately, and so do the keys that it saves.
const TOLERANCE: f64 = 1e-3;

/// MuJoCo replaces shorter quaternions by (1, 0, 0, 0).
const SHORTEST: f64 = 1e-15;

/// A `<key>`.
pub(crate) struct Key<'a> {
    element: Element<'a>,
    name: Name,
    time: f64,
    qpos: Option<Numbers<'a>>,
    qvel: Option<Numbers<'a>>,
    place: Place,
}

struct Numbers<'a> {
    value: Value<'a>,
    numbers: Vec<f64>,
}

impl<'a> Key<'a> {
    /// The keys of all sections, in the order of the file.
    pub fn read<'s>(sections: impl Iterator<Item = &'s Element<'a>>, cx: &mut Context) -> Vec<Key<'a>>
    where
        'a: 's,
    {
        let mut keys = Vec::new();
        for section in sections {
            section.check_attributes(&vocabulary::KEYFRAME, cx);
            section.check_children(&vocabulary::KEYFRAME, cx);
            for element in section.elements().filter(|child| child.name() == "key") {
                if cx.findings.is_full() {
                    return keys;
                }
                keys.push(Key::of(&element.called("key"), keys.len(), cx));
            }
        }
        keys
    }

    fn of(element: &Element<'a>, number: usize, cx: &mut Context) -> Self {
        let name = Name::of(element, format!("key{number}"), cx);
        let element = element.called(format!("key `{}`", name.shown()));
        element.check_attributes(&vocabulary::KEY, cx);
        element.check_children(&vocabulary::KEY, cx);
        let mut place = Place::new(element.span());
        if let Some(value) = element.attribute("name") {
            place.set("name", value.span);
        }
        let time = element.attribute("time").and_then(|value| element.vector::<1>("time", &value, cx));
        let [qpos, qvel] = ["qpos", "qvel"].map(|attribute| numbers(&element, attribute, cx));
        Key { name, time: time.map_or(0.0, |[time]| time), qpos, qvel, place, element }
    }
}

/// The numbers of an attribute; None if there are none or, with a diagnostic, if they are invalid.
fn numbers<'a>(element: &Element<'a>, attribute: &str, cx: &mut Context) -> Option<Numbers<'a>> {
    let value = element.attribute(attribute)?;
    match all_numbers(value.text) {
        Ok(numbers) if numbers.is_empty() => None, // as MuJoCo reads it
        Ok(numbers) => Some(Numbers { value, numbers }),
        Err(error) => {
            element.report_numbers(attribute, &value, error, cx);
            None
        }
    }
}

/// Gives the robot its keys as states, and `qpos0` as its start if this is not the neutral configuration. Returns the
/// names of the states with their elements.
pub(crate) fn add<'a>(
    keys: Vec<Key<'a>>,
    slots: &[Slot],
    description: &mut Description,
    places: &mut Places,
    cx: &mut Context,
) -> Vec<(String, Element<'a>)> {
    let mut added = Vec::new();
    let qpos0: Vec<f64> = slots.iter().flat_map(|slot| slot.qpos0.iter().copied()).collect();
    if let (true, Some(key)) = (keys.len() * qpos0.len() > MOST_POSITIONS, keys.first()) {
        let message = format!(
            "keyframe: has {} of {}, expected at most {MOST_POSITIONS} in all",
            counted(keys.len(), "key"),
            counted(qpos0.len(), "position")
        );
        cx.findings.error("too_many_keys", key.element.span(), message);
        return added;
    }
    if keys.is_empty() && slots.iter().all(Slot::is_neutral) {
        return added;
    }
    // errors of the robot itself are reported later
    let Some(coordinates) = Coordinates::new(slots, description) else { return added };
    let given: BTreeSet<String> = keys.iter().filter_map(|key| key.name.given.clone()).collect();
    let mut names = Names::new("key", given);
    let rest = vec![0.0; slots.iter().map(Slot::velocities).sum()];
    if let Some(start) = coordinates.state(0.0, &qpos0, &rest).filter(|start| !coordinates.is_neutral(start)) {
        let name = names.settle(Name::generated(QPOS0.to_string()), &places.robot, cx);
        coordinates.name(name.clone(), &start, description);
        places.states.push(places.robot.clone());
        description.start = Some(name);
    }
    for key in keys {
        let name = names.settle(key.name, &key.place, cx);
        let element = key.element.called(format!("key `{}`", shown(&name)));
        let qpos = sized(&element, "qpos", &key.qpos, &qpos0, cx)
            .and_then(|qpos| normalized(&element, &key.qpos, qpos, slots, cx));
        let (Some(qpos), Some(qvel)) = (qpos, sized(&element, "qvel", &key.qvel, &rest, cx)) else { continue };
        for (attribute, given, list) in [("qpos", &key.qpos, &qpos), ("qvel", &key.qvel, &qvel)] {
            let Some(given) = given else { continue };
            let wrong = coordinates.contradictions(list, attribute == "qvel", TOLERANCE);
            contradictory(&element, attribute, given, &wrong, cx);
        }
        if let Some(state) = coordinates.state(key.time, &qpos, &qvel) {
            coordinates.name(name.clone(), &state, description);
            places.states.push(key.place);
            added.push((name, key.element));
        }
    }
    added
}

/// Reports mimic joints whose coupling disagrees with a key.
fn contradictory(element: &Element, attribute: &str, given: &Numbers, wrong: &[String], cx: &mut Context) {
    let [first, more @ ..] = wrong else { return };
    let more = if more.is_empty() { String::new() } else { format!(" (and {} more)", more.len()) };
    let message = format!("{}: {attribute}: {first}{more}", element.subject);
    let help = "mozzi keeps the coupling and uses the numbers of the independent joints";
    cx.findings.add(Finding::warning("contradictory_key", given.value.span.clone(), message).help(help));
}

/// The numbers of a key, or the default; None, with a diagnostic, if there are too few or too many.
fn sized(
    element: &Element,
    attribute: &str,
    given: &Option<Numbers>,
    default: &[f64],
    cx: &mut Context,
) -> Option<Vec<f64>> {
    let Some(Numbers { value, numbers }) = given else { return Some(default.to_vec()) };
    if numbers.len() == default.len() {
        return Some(numbers.clone());
    }
    let (found, expected) = (counted(numbers.len(), "number"), default.len());
    let message = format!("{}: {attribute}: has {found}, expected {expected}", element.subject);
    let help = match attribute {
        "qpos" => "one for each hinge and slide, 4 for a ball, 7 for a free joint, in the order of the file",
        _ => "one for each hinge and slide, 3 for a ball, 6 for a free joint, in the order of the file",
    };
    cx.findings.add(Finding::error("wrong_count", value.span.clone(), message).help(help));
    None
}

/// Normalizes quaternions as MuJoCo does: one of length 0 is (1, 0, 0, 0). One that is not finite is an error.
fn normalized(
    element: &Element,
    given: &Option<Numbers>,
    mut qpos: Vec<f64>,
    slots: &[Slot],
    cx: &mut Context,
) -> Option<Vec<f64>> {
    let (span, mut at) = (given.as_ref().map_or_else(|| element.span(), |given| given.value.span.clone()), 0);
    for slot in slots {
        if let Some(range) = slot.quaternion() {
            let q = &mut qpos[at + range.start..at + range.end];
            let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let subject = format!("{}: qpos: the quaternion of joint `{}`", element.subject, slot.shown);
            if length < SHORTEST {
                let message = format!("{subject} has the length {length}, and is (1, 0, 0, 0) here");
                let help = "as in MuJoCo; expected a unit quaternion (w, x, y, z)";
                cx.findings.add(Finding::warning("key_quaternion", span.clone(), message).help(help));
                q.copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
            } else if !length.is_finite() {
                let message = format!("{subject} has the length {length}, expected a unit quaternion (w, x, y, z)");
                cx.findings.error("zero_axis", span, message);
                return None;
            } else {
                if (length - 1.0).abs() > TOLERANCE {
                    let message = format!("{subject} has the length {length}, and is normalized");
                    let help = "MuJoCo normalizes it, too; expected a unit quaternion (w, x, y, z)";
                    cx.findings.add(Finding::warning("key_quaternion", span.clone(), message).help(help));
                }
                q.iter_mut().for_each(|x| *x /= length);
            }
        }
        at += slot.qpos0.len();
    }
    Some(qpos)
}
