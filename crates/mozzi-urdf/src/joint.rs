//! `<joint>`.

use crate::axis;
use crate::context::Context;
use crate::element::{Children, Element};
use crate::finding::Finding;
use crate::limit;
use crate::origin;
use crate::places::Place;
use crate::spelling::did_you_mean;
use crate::words::{DYNAMICS, JOINT, JOINT_TYPES, MIMIC, PARENT, list, shown};
use mozzi::SE3;
use mozzi::model::description::{Joint, JointKind, Limits, Mimic};

/// A joint. What cannot be read is reported, and left as if it were not there.
pub(crate) fn read(element: &Element, cx: &mut Context) -> (Joint, Place) {
    let mut place = Place::new(element.span());
    let mut element = element.called("joint");
    let value = element.required_name("name", cx);
    let name = place.note("name", value);
    element.subject = format!("joint `{}`", shown(&name));
    let before = cx.findings.errors();
    element.check_attributes(&JOINT, cx);
    let children = element.check_children(&JOINT, cx);
    if cx.findings.errors() > before {
        place.report("limits"); // a misspelled <limit> is not a missing one
    }

    let parent = read_end("parent", &element, &children, &mut place, cx);
    let child = read_end("child", &element, &children, &mut place, cx);
    let origin = children.get("origin").map_or(Some(SE3::identity()), |origin| origin::read(origin, cx));
    if let Some(origin) = children.get("origin") {
        place.set("origin", origin.span());
    }
    let kind = read_type(&element, cx);
    // what a joint that does not move has of these means nothing
    let (screw, limits) = match kind {
        None | Some("fixed") => (None, Limits::default()),
        Some(kind) => {
            let screw = axis::read(kind, children.get("axis"), &element, cx);
            (screw, limit::read(kind, children.get("limit"), &element, &mut place, cx))
        }
    };
    let [damping, friction] = read_dynamics(&children, &mut place, cx);
    let joint = Joint {
        name,
        parent,
        child,
        origin: origin.unwrap_or_else(SE3::identity),
        kind: screw.map_or(JointKind::Fixed, JointKind::Screw),
        limits,
        damping,
        friction,
        armature: 0.0,
        mimic: children.get("mimic").and_then(|mimic| read_mimic(mimic, &mut place, cx)),
    };
    if kind != Some("fixed") && joint.kind == JointKind::Fixed {
        place.report("kind");
    }
    (joint, place)
}

/// One of the types that mozzi computes; None, and reported, for others.
fn read_type(element: &Element, cx: &mut Context) -> Option<&'static str> {
    let value = element.required("type", cx)?;
    let known = JOINT_TYPES.into_iter().find(|&known| known == value.text);
    if known.is_some() {
        return known;
    }
    let subject = &element.subject;
    cx.findings.add(match value.text {
        "floating" | "planar" => {
            let freedoms = if value.text == "planar" { "three" } else { "six" };
            let message = format!("{subject}: type: is `{}`, which has {freedoms} freedoms", value.text);
            let help = format!("mozzi computes joints of one freedom or none: {}; a base that moves is given to the functions as its twist and acceleration", list(&JOINT_TYPES));
            Finding::error("unsupported_joint", value.span, message).help(help)
        }
        other => {
            let message = format!("{subject}: type: is `{}`, expected one of {}", shown(other), list(&JOINT_TYPES));
            Finding::error("unknown_joint_type", value.span, message).maybe_help(did_you_mean(other, JOINT_TYPES))
        }
    });
    None
}

/// The link of `<parent>` or `<child>`.
fn read_end(name: &'static str, element: &Element, children: &Children, place: &mut Place, cx: &mut Context) -> String {
    let Some(end) = children.get(name) else {
        let message = format!("{}: has no <{name}>", element.subject);
        let help = format!("name the link: <{name} link=\"…\"/>");
        cx.findings.add(Finding::error("missing_element", element.span(), message).help(help));
        return place.note(name, None);
    };
    end.check_attributes(&PARENT, cx);
    end.check_children(&PARENT, cx);
    let value = end.required_name("link", cx);
    place.note(name, value)
}

/// Damping and friction.
fn read_dynamics(children: &Children, place: &mut Place, cx: &mut Context) -> [f64; 2] {
    let Some(dynamics) = children.get("dynamics") else { return [0.0; 2] };
    dynamics.check_attributes(&DYNAMICS, cx);
    dynamics.check_children(&DYNAMICS, cx);
    ["damping", "friction"].map(|name| {
        if let Some(value) = dynamics.attribute(name) {
            place.set(name, value.span);
        }
        dynamics.number(name, cx).unwrap_or(0.0)
    })
}

fn read_mimic(mimic: &Element, place: &mut Place, cx: &mut Context) -> Option<Mimic> {
    mimic.check_attributes(&MIMIC, cx);
    mimic.check_children(&MIMIC, cx);
    let mut number = |name, default| match mimic.attribute(name) {
        Some(value) => mimic.vector::<1>(name, &value, cx).map(|[x]| x),
        None => Some(default),
    };
    let (ratio, offset) = (number("multiplier", 1.0), number("offset", 0.0));
    let joint = mimic.required_name("joint", cx)?;
    place.set("mimic", joint.span);
    Some(Mimic { joint: joint.text.to_string(), ratio: ratio?, offset: offset? })
}
