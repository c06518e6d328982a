//! Elements and attributes that URDF does not define: those of Drake, Gazebo, MuJoCo, or an unknown namespace. Those
//! that could change the motion are reported.

use crate::report::finding::Finding;
use crate::text::context::{Context, Unknown};
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;

/// Elements of Drake that are read, or that concern only contacts and appearance.
const DRAKE: [&str; 6] = [
    "drake:joint",
    "drake:ball_constraint",
    "drake:screw_thread_pitch",
    "drake:rotor_inertia",
    "drake:gear_ratio",
    "drake:collision_filter_group",
];

/// Further elements of Drake that are read, in SDFormat only.
const DRAKE_IN_SDF: [&str; 4] = ["drake:parent", "drake:child", "drake:damping", "drake:mimic"];

/// Elements of Drake that act on the robot, and their effect.
const FORCES: [(&str, &str); 4] = [
    ("drake:linear_bushing_rpy", "is a bushing: springs and dampers between two frames"),
    ("drake:linear_spring_damper", "is a spring and a damper between two points"),
    ("drake:tendon_constraint", "is a tendon: it limits a sum of joint positions, or is a spring and a damper on it"),
    ("drake:controller_gains", "is a controller of the joint"),
];

/// Prefixes of attributes and elements that do not affect the motion: XML's own, and those of sensors and controllers
/// in URDFs of Gazebo's first versions.
const HARMLESS: [&str; 5] = ["xml", "xsi", "sensor", "controller", "interface"];

/// Reports an element with a prefix, unless it is read elsewhere or does not matter.
pub(crate) fn element(child: &Element, parent: &Element, cx: &mut Context) {
    let written = child.written_name();
    let of_sdf = cx.dialect == Dialect::Sdf && DRAKE_IN_SDF.contains(&written);
    if DRAKE.contains(&written) || of_sdf || is_harmless(written) {
        return;
    }
    if let Some((_, what)) = FORCES.iter().find(|(known, _)| *known == written) {
        let message = format!("{}: {written}: {what}, which mozzi does not compute", parent.subject);
        cx.findings.add(Finding::warning("ignored_force", child.span(), message));
        return;
    }
    if let Unknown::First = cx.unknown(parent.name(), written, "element", []) {
        let (parent, written) = (&parent.subject, shown(written));
        let message =
            format!("{parent}: has an element <{written}>, which mozzi does not read; it may change the motion");
        let help = "this and all others like it are ignored; remove them, or compute their effect separately";
        cx.findings.add(Finding::warning("unknown_element", child.span(), message).help(help));
    }
}

/// Reports an attribute with a prefix, unless it is read elsewhere or does not matter.
pub(crate) fn attribute(on: &Element, written: &str, span: std::ops::Range<usize>, cx: &mut Context) {
    if written == "drake:acceleration" || is_harmless(written) {
        return;
    }
    if let Unknown::First = cx.unknown(on.name(), written, "attribute", []) {
        let (subject, written) = (&on.subject, shown(written));
        let message =
            format!("{subject}: has an attribute `{written}`, which mozzi does not read; it may change the motion");
        let help = "this and all others like it are ignored; remove them, or compute their effect separately";
        cx.findings.add(Finding::warning("unknown_attribute", span, message).help(help));
    }
}

fn is_harmless(written: &str) -> bool {
    written.split_once(':').is_some_and(|(prefix, _)| HARMLESS.contains(&prefix))
}

/// The effect of a `<gazebo>` on the motion, by the name of an element in it; None if it has no effect.
fn of_gazebo(element: &Element) -> Option<&'static str> {
    let text = element.text().trim();
    let is_set = ["1", "true", "True"].contains(&text);
    let is_number = text.parse::<f64>().is_ok_and(|x| x != 0.0);
    match element.name() {
        "turnGravityOff" if is_set => Some("switches gravity off for this link"),
        "gravity" if ["0", "false", "False"].contains(&text) => Some("switches gravity off for this link"),
        "kinematic" if is_set => Some("prescribes the motion of this link"),
        "static" if is_set => Some("fixes the robot to the world"),
        "springStiffness" if is_number => Some("is the stiffness of a spring"),
        "dampingFactor" if is_number => Some("damps the motion of this link"),
        "joint" => Some("is a further joint, which may close a loop"),
        "link" | "model" | "include" => Some("is a further body"),
        _ => None,
    }
}

/// MuJoCo's settings in a URDF that change the robot: attributes of elements in `<mujoco>`.
const OF_MUJOCO: [(&str, &[&str]); 2] = [
    ("compiler", &["balanceinertia", "boundinertia", "boundmass", "inertiafromgeom", "settotalmass", "coordinate"]),
    ("option", &["gravity", "density", "viscosity", "wind"]),
];

/// Reports the effects of `<gazebo>` and `<mujoco>` on the motion, once per kind; nothing for other elements.
pub(crate) fn settings(element: &Element, cx: &mut Context) {
    match element.name() {
        "gazebo" => gazebo(element, cx),
        "mujoco" => mujoco(element, cx),
        _ => {}
    }
}

fn gazebo(element: &Element, cx: &mut Context) {
    let of = element.attribute("reference").map_or_else(String::new, |link| format!(" `{}`", shown(link.text)));
    for child in element.elements().filter(|child| !child.has_prefix()) {
        let (name, Some(what)) = (child.name(), of_gazebo(&child)) else { continue };
        let message = format!("gazebo{of}: {name}: {what} in Gazebo, which mozzi does not read");
        cx.repeat(&format!("gazebo {name}"), Finding::warning("ignored_force", child.span(), message));
    }
}

fn mujoco(element: &Element, cx: &mut Context) {
    for child in element.elements() {
        let name = child.name();
        let known = OF_MUJOCO.iter().find(|(known, _)| *known == name).map_or(&[][..], |(_, names)| names);
        for attribute in known {
            let Some(value) = child.attribute(attribute) else { continue };
            let text = shown(value.text);
            let message = format!("mujoco: {name}: {attribute}: is `{text}`, which MuJoCo applies and mozzi does not");
            let kind = format!("mujoco {name} {attribute}");
            cx.repeat(&kind, Finding::warning("ignored_force", value.span, message));
        }
    }
}
