//! `<axis>` and `<axis2>`: direction, limits, friction, spring and coupling.

use super::part::Part;
use super::version::Version;
use super::vocabulary::{AXIS, DYNAMICS, LIMIT, MIMIC};
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use mozzi::Vec3;
use mozzi::model::UNLIMITED;
use mozzi::model::description::Limits;
use std::ops::Range;

/// Which frame the direction is given in.
#[derive(Clone)]
pub(crate) enum Axes<'a> {
    Joint,
    Model,
    Frame(Value<'a>),
}

/// A coupling to another joint's axis, by its name in the file.
#[derive(Clone)]
pub(crate) struct Coupling<'a> {
    pub joint: Value<'a>,
    pub axis: String,
    pub ratio: f64,
    pub offset: f64,
}

#[derive(Clone)]
pub(crate) struct Axis<'a> {
    pub xyz: Vec3,
    pub axes: Axes<'a>,
    pub span: Range<usize>,
    pub limits: Limits,
    pub damping: f64,
    pub friction: f64,
    pub stiffness: f64,
    pub spring_reference: f64,
    pub mimic: Option<Coupling<'a>>,
    pub initial: f64,
}

impl<'a> Axis<'a> {
    /// None, with a diagnostic, if it has no direction. The places of its numbers are those of the joint.
    pub fn read(element: &Element<'a>, version: Version, place: Option<&mut Place>, cx: &mut Context) -> Option<Self> {
        let part = Part::new(element.clone(), &AXIS, cx);
        let xyz = match part.child("xyz") {
            Some(_) => part.vector::<3>("xyz", cx),
            None => {
                let message = format!("{}: has no <xyz>, expected the direction", element.subject);
                cx.findings.error("missing_element", element.span(), message);
                None
            }
        };
        let expressed_in = part.child("xyz").and_then(|xyz| xyz.attribute("expressed_in"));
        let is_old = version < Version::WITH_FRAMES;
        let of_model = part.flag("use_parent_model_frame", version < Version::WITH_AXES_IN_JOINT, cx);
        if of_model && !is_old {
            let message = format!("{}: use_parent_model_frame is of versions before 1.7", element.subject);
            let help = "write <xyz expressed_in=\"__model__\"> instead, or the file's version";
            let span = part.span("use_parent_model_frame");
            cx.findings.add(Finding::error("unknown_element", span, message).help(help));
        }
        let axes = match expressed_in.filter(|value| !value.text.is_empty()) {
            Some(frame) => Axes::Frame(frame),
            None if of_model && is_old => Axes::Model,
            None => Axes::Joint,
        };
        let nowhere = &mut Place::default();
        let place = place.unwrap_or(nowhere);
        let mut numbers = [0.0; 4];
        if let Some(dynamics) = part.child("dynamics") {
            let dynamics = Part::new(dynamics.clone(), &DYNAMICS, cx);
            for (number, (name, check)) in numbers.iter_mut().zip(NUMBERS) {
                *number = dynamics.number(name, 0.0, cx);
                place.set(check, dynamics.span(name));
            }
        }
        let [damping, friction, stiffness, spring_reference] = numbers;
        let limits = part.child("limit").map_or_else(Limits::default, |limit| limits(limit, place, cx));
        let mimic = part.child("mimic").and_then(|mimic| coupling(mimic, place, cx));
        let (initial, span) = (part.number("initial_position", 0.0, cx), part.span("xyz"));
        let xyz = Vec3(xyz?);
        Some(Axis { xyz, axes, span, limits, damping, friction, stiffness, spring_reference, mimic, initial })
    }
}

/// Words, and the names of their numbers in the checks.
const NUMBERS: [(&str, &str); 4] = [
    ("damping", "damping"),
    ("friction", "friction"),
    ("spring_stiffness", "stiffness"),
    ("spring_reference", "spring reference"),
];

fn limits(element: &Element, place: &mut Place, cx: &mut Context) -> Limits {
    let part = Part::new(element.clone(), &LIMIT, cx);
    for (name, attribute) in [("lower", "limits"), ("velocity", "velocity limit"), ("effort", "effort limit")] {
        if part.child(name).is_some() {
            place.set(attribute, part.span(name));
        }
    }
    let [lower, upper, velocity, effort] = ["lower", "upper", "velocity", "effort"].map(|name| part.bound(name, cx));
    let low = lower.filter(|x| *x > -UNLIMITED);
    let high = upper.filter(|x| *x < UNLIMITED);
    let mut position = match (low, high) {
        (None, None) => None,
        // a bound that does not exist is the largest number
        (low, high) => Some([low.unwrap_or(-f64::MAX), high.unwrap_or(f64::MAX)]),
    };
    if let Some([low, high]) = position.filter(|[low, high]| low > high) {
        let message = format!("{}: goes from {low} to {high}, expected the lower bound first", element.subject);
        let help = "the joint is treated as unlimited; exchange <lower> and <upper>";
        cx.findings.add(Finding::warning("reversed_limits", part.span("lower"), message).help(help));
        position = None;
    }
    // negative numbers mean no limit
    let rate = |limit: Option<f64>| limit.filter(|x| (0.0..UNLIMITED).contains(x));
    Limits { position, velocity: rate(velocity), effort: rate(effort), acceleration: None }
}

/// θ = multiplier (θ_source − reference) + offset.
fn coupling<'a>(element: &Element<'a>, place: &mut Place, cx: &mut Context) -> Option<Coupling<'a>> {
    let part = Part::new(element.clone(), &MIMIC, cx);
    let [ratio, offset, reference] = [("multiplier", 1.0), ("offset", 0.0), ("reference", 0.0)]
        .map(|(name, default)| part.number(name, default, cx));
    let joint = element.required_name("joint", cx)?;
    let axis = element.attribute("axis").map_or("axis", |value| value.text).to_string();
    place.set("mimic", joint.span.clone());
    Some(Coupling { joint, axis, ratio, offset: offset - ratio * reference })
}

/// `<drake:mimic joint="…" multiplier="…" offset="…"/>`.
pub(crate) fn of_drake<'a>(element: &Element<'a>, cx: &mut Context) -> Option<Coupling<'a>> {
    let joint = element.required_name("joint", cx)?;
    let ratio = element.number("multiplier", cx).unwrap_or(1.0);
    let offset = element.number("offset", cx).unwrap_or(0.0);
    Some(Coupling { joint, axis: "axis".to_string(), ratio, offset })
}
