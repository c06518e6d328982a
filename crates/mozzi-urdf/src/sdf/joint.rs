//! `<joint>`, `<drake:joint>` and their axes, before frames are known.

use super::axis::Axis;
use super::graph::{Node, Scope, What};
use super::part::Part;
use super::pose::Pose;
use super::version::Version;
use super::vocabulary::{JOINT, JOINT_TYPES};
use super::{Reader, full_name};
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::urdf::vocabulary::{NOTHING, Vocabulary, list, shown};
use core::f64::consts::TAU;
use std::rc::Rc;

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Fixed,
    Turns,
    Slides,
    /// The travel per turn along the axis, m.
    Screw(f64),
    Ball,
    /// About two axes, one after the other.
    TwoAxes,
    /// Damping along x and y, and about z of the joint's frame.
    Planar([f64; 3]),
}

/// A joint; its node has its frame.
pub(crate) struct Joint<'a> {
    pub name: String,
    pub subject: String,
    pub scope: Rc<Scope>,
    pub node: usize,
    pub kind: Kind,
    pub parent: Option<Value<'a>>,
    pub child: Option<Value<'a>>,
    pub axes: Vec<Axis<'a>>,
    /// Rotor inertia and gear ratio.
    pub rotor: [f64; 2],
    pub place: Place,
}

const DRAKE_JOINT: Vocabulary = Vocabulary { attributes: &["name", "type"], ..NOTHING };

impl<'a> Reader<'a> {
    pub fn joint(&mut self, element: &Element<'a>, scope: &Rc<Scope>, version: Version, cx: &mut Context) {
        let mut place = Place::new(element.span());
        let value = element.called("joint").required_name("name", cx);
        let name = full_name(scope, &place.note("name", value));
        let subject = format!("joint `{}`", shown(&name));
        let element = element.called(subject.clone());
        let is_drake = element.written_name() == "drake:joint";
        let part = Part::new(element, if is_drake { &DRAKE_JOINT } else { &JOINT }, cx);
        let of_drake =
            |name: &str| part.element.elements().find(|child| child.written_name() == format!("drake:{name}"));
        let (parent, child) = match is_drake {
            true => (drake_name(&part, "parent", cx), drake_name(&part, "child", cx)),
            false => (part.name_of("parent", cx), part.name_of("child", cx)),
        };
        for (name, end) in [("parent", &parent), ("child", &child)] {
            place.note(name, end.clone());
        }
        let kind = if is_drake { drake_kind(&part, cx) } else { kind(&part, cx) };
        if let Some(value) = part.element.attribute("type") {
            place.set("kind", value.span);
        }
        let needed: &[&str] = match kind {
            Some(Kind::Turns | Kind::Slides | Kind::Screw(_)) => &["axis"],
            Some(Kind::TwoAxes) => &["axis", "axis2"],
            _ => &[],
        };
        let mut axes = Vec::new();
        for name in needed {
            match part.child(name) {
                Some(axis) => axes.extend(Axis::read(axis, version, (axes.is_empty()).then_some(&mut place), cx)),
                None => {
                    let message = format!("{subject}: has no <{name}>");
                    let help = "give its direction: <axis><xyz>0 0 1</xyz></axis>";
                    cx.findings.add(Finding::error("missing_element", part.element.span(), message).help(help));
                }
            }
        }
        let is_complete = axes.len() == needed.len();
        if let Some(axis) = part.child("axis").filter(|_| kind == Some(Kind::Ball)) {
            axes.extend(Axis::read(axis, version, Some(&mut place), cx));
        }
        if !is_complete || kind.is_none() {
            place.report("kind");
        }
        let rotor = ["rotor_inertia", "gear_ratio"].map(|name| {
            let value = of_drake(name).map(|child| child.content());
            value.and_then(|value| part.element.vector::<1>(&format!("drake:{name}"), &value, cx)).map(|[x]| x)
        });
        if of_drake("mimic").is_some() && axes.len() == 1 {
            axes[0].mimic =
                axes[0].mimic.take().or_else(|| of_drake("mimic").and_then(|m| super::axis::of_drake(&m, cx)));
        }
        self.plugins(&part.element, cx);
        let pose = Pose::of(&part, version, cx);
        let relative_to = pose.relative_to.or_else(|| child.clone());
        let node =
            Node { T: pose.T, relative_to, carrier: child.clone(), ..Node::new(What::Joint, scope, subject.clone()) };
        let node = self.named(&name, node, &place, version, cx);
        let kind = kind.filter(|_| is_complete).unwrap_or(Kind::Fixed);
        let rotor = [rotor[0].unwrap_or(0.0), rotor[1].unwrap_or(1.0)];
        self.joints.push(Joint { name, subject, scope: scope.clone(), node, kind, parent, child, axes, rotor, place });
    }
}

/// One of SDFormat's types; None, with a diagnostic, for one that mozzi does not compute.
fn kind(part: &Part, cx: &mut Context) -> Option<Kind> {
    let subject = &part.element.subject;
    let value = part.element.required("type", cx)?;
    Some(match value.text {
        "fixed" => Kind::Fixed,
        "revolute" | "continuous" => Kind::Turns,
        "prismatic" => Kind::Slides,
        "ball" => Kind::Ball,
        "universal" | "revolute2" => Kind::TwoAxes,
        "screw" => Kind::Screw(travel(part, cx)?),
        "gearbox" => {
            let message = format!("{subject}: type: is `gearbox`, a coupling of two joints, which mozzi does not read");
            let help = "couple the joints by a <mimic> in the <axis> of one of them";
            cx.findings.add(Finding::error("unsupported_joint", value.span, message).help(help));
            return None;
        }
        other => {
            let message = format!("{subject}: type: is `{}`, expected one of {}", shown(other), list(&JOINT_TYPES));
            let help = did_you_mean(other, JOINT_TYPES);
            cx.findings.add(Finding::error("unknown_joint_type", value.span, message).maybe_help(help));
            return None;
        }
    })
}

/// The travel of a screw per turn: `screw_thread_pitch`, or −2π / `thread_pitch`, in radians per metre and of the
/// opposite sign.
fn travel(part: &Part, cx: &mut Context) -> Option<f64> {
    let names = ["screw_thread_pitch", "thread_pitch"];
    let [travel, turns] = names.map(|name| part.vector::<1>(name, cx).map(|[x]| x));
    let implied = turns.map(|turns| -TAU / turns);
    let subject = &part.element.subject;
    match (travel, implied) {
        (Some(travel), Some(implied)) if (travel - implied).abs() > 1e-6 * travel.abs() => {
            let message = format!(
                "{subject}: screw_thread_pitch is {travel} m per turn, thread_pitch means {implied} m per turn"
            );
            let help = "keep one of them: thread_pitch is -2π / screw_thread_pitch";
            cx.findings.add(Finding::error("contradictory_pitch", part.span("thread_pitch"), message).help(help));
            None
        }
        (Some(travel), _) => Some(travel),
        (None, Some(implied)) if implied.is_finite() => Some(implied),
        (None, Some(_)) => {
            let message = format!("{subject}: thread_pitch: is 0, expected the turn per metre, in radians");
            cx.findings.error("not_finite", part.span("thread_pitch"), message);
            None
        }
        (None, None) => {
            let is_there = names.iter().any(|name| part.child(name).is_some());
            if !is_there {
                let message = format!("{subject}: has no <screw_thread_pitch>, expected the travel per turn");
                let help = "write <screw_thread_pitch>…</screw_thread_pitch>, in metres per revolution";
                cx.findings.add(Finding::error("missing_element", part.element.span(), message).help(help));
            }
            None
        }
    }
}

/// The only type of a <drake:joint> that SDFormat does not have itself.
fn drake_kind(part: &Part, cx: &mut Context) -> Option<Kind> {
    let subject = &part.element.subject;
    let value = part.element.required("type", cx)?;
    if value.text != "planar" {
        let message = format!("{subject}: type: is `{}`, expected `planar` of a <drake:joint>", shown(value.text));
        cx.findings.error("unsupported_joint", value.span, message);
        return None;
    }
    let damping = part.element.elements().find(|child| child.written_name() == "drake:damping");
    let Some(damping) = damping else { return Some(Kind::Planar([0.0; 3])) };
    part.element.vector::<3>("drake:damping", &damping.content(), cx).map(Kind::Planar)
}

/// The text of `<drake:parent>` or `<drake:child>`.
fn drake_name<'a>(part: &Part<'a>, name: &str, cx: &mut Context) -> Option<Value<'a>> {
    let word = format!("drake:{name}");
    let found = part.element.elements().find(|child| child.written_name() == word).map(|child| child.content());
    if found.as_ref().is_none_or(|value| value.text.is_empty()) {
        let message = format!("{}: has no <{word}>", part.element.subject);
        cx.findings.error("missing_element", part.element.span(), message);
        return None;
    }
    found
}
