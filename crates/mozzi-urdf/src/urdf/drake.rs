//! Drake's extensions of URDF, as Drake's parser reads them: `<drake:joint>` of the types ball, planar, screw and
//! universal; `<drake:ball_constraint>`. Rotors are in `transmission.rs`.

use crate::report::finding::Finding;
use crate::report::places::{Place, Places};
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::axis;
use crate::urdf::extension;
use crate::urdf::vocabulary::shown;
use crate::urdf::write::ball_name;
use core::f64::consts::TAU;
use mozzi::model::description::{Anchor, Constraint};
use mozzi::{Description, SE3, ScrewAxis, Vec3};

/// The types of a `<drake:joint>` that mozzi computes.
pub(crate) const JOINT_TYPES: [&str; 4] = ["ball", "planar", "screw", "universal"];

/// The helical joint of a screw: its pitch is the travel per revolution, in metres.
pub(crate) fn screw(joint: &Element, direction: Option<&Element>, cx: &mut Context) -> Option<ScrewAxis> {
    let turn = axis::read("revolute", direction, joint, cx);
    let Some(pitch) = child(joint, "drake:screw_thread_pitch") else {
        let message = format!("{}: has no <drake:screw_thread_pitch>, expected the travel per turn", joint.subject);
        let help = "write <drake:screw_thread_pitch value=\"…\"/>, in metres per revolution";
        cx.findings.add(Finding::error("missing_element", joint.span(), message).help(help));
        return None;
    };
    let [travel] = value(&pitch, cx)?;
    let w = turn?.twist().w;
    let line = ScrewAxis::from_line(w.0, [0.0; 3], travel / TAU);
    if line.is_err() {
        let message = format!("{}: is {travel}, expected a finite travel per turn", pitch.subject);
        cx.findings.error("not_finite", pitch.span(), message);
    }
    line.ok()
}

/// The damping of a planar joint's two slides and its turn.
pub(crate) fn planar_damping(dynamics: Option<&Element>, cx: &mut Context) -> Option<[f64; 3]> {
    let Some(dynamics) = dynamics else { return Some([0.0; 3]) };
    let Some(value) = dynamics.attribute("damping") else { return Some([0.0; 3]) };
    let damping = dynamics.vector::<3>("damping", &value, cx)?;
    if damping.iter().all(|x| *x >= 0.0) {
        return Some(damping);
    }
    let message = format!("{}: damping: is `{}`, expected numbers of at least 0", dynamics.subject, shown(value.text));
    cx.findings.error("negative_friction", value.span, message);
    None
}

/// Drake's universal joint turns about the x-axis of its frame, whatever its `<axis>` is.
pub(crate) fn check_universal(direction: Option<&Element>, cx: &mut Context) {
    let Some(direction) = direction else { return };
    let given = direction.attribute("xyz").and_then(|value| direction.vector::<3>("xyz", &value, cx));
    if given.is_some_and(|xyz| Vec3(xyz) != Vec3([1.0, 0.0, 0.0])) {
        let message = format!("{}: is ignored: a universal joint turns about x, then y", direction.subject);
        cx.findings.add(Finding::warning("ignored_property", direction.span(), message));
    }
}

/// `<drake:ball_constraint>`: point P of body A and point Q of body B coincide.
pub(crate) fn ball_constraint(element: &Element, description: &mut Description, places: &mut Places, cx: &mut Context) {
    const PREFIX: &str = "drake:ball_constraint";
    let mut place = Place::new(element.span());
    let number = description.constraints.len();
    let name = ball_name(number);
    let element = element.called(format!("{} `{name}`", element.subject));
    let part = |suffix: &str, cx: &mut Context| {
        let found = child(&element, &format!("{PREFIX}_{suffix}"));
        if found.is_none() {
            let message = format!("{}: has no <{PREFIX}_{suffix}>", element.subject);
            cx.findings.error("missing_element", element.span(), message);
        }
        found
    };
    let mut anchor = |[body, point]: [&str; 2], attribute, cx: &mut Context| {
        let (body, point) = (part(body, cx), part(point, cx));
        let body = body.and_then(|body| body.required_name("name", cx));
        let point = point.and_then(|point| {
            let value = point.required("value", cx)?;
            point.vector::<3>("value", &value, cx)
        });
        let (body, point) = (body?, point?);
        place.set(attribute, body.span);
        Some(Anchor::frame(body.text).at(SE3::translation(point)))
    };
    let a = anchor(["body_A", "p_AP"], "a", cx);
    let b = anchor(["body_B", "p_BQ"], "b", cx);
    if let (Some(a), Some(b)) = (a, b) {
        description.constraints.push(Constraint::point(name, a, b));
        places.constraints.push(place);
    }
}

/// Reports the effects of Drake's other elements in an actuator.
pub(crate) fn check_words(actuator: &Element, cx: &mut Context) {
    for word in actuator.elements().filter(|child| child.written_name().starts_with("drake:")) {
        extension::element(&word, actuator, cx);
    }
}

/// The first child with this name, prefix included.
fn child<'a>(element: &Element<'a>, name: &str) -> Option<Element<'a>> {
    element.elements().find(|child| child.written_name() == name)
}

/// The number in the attribute `value`.
pub(crate) fn value(element: &Element, cx: &mut Context) -> Option<[f64; 1]> {
    let value = element.required("value", cx)?;
    element.vector::<1>("value", &value, cx)
}
