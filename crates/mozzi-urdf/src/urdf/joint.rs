//! `<joint>`.

use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::{Children, Element};
use crate::urdf::axis;
use crate::urdf::drake;
use crate::urdf::limit;
use crate::urdf::origin;
use crate::urdf::series::{self, Part};
use crate::urdf::vocabulary::{DYNAMICS, JOINT, JOINT_TYPES, LIMIT, MIMIC, PARENT, list, shown};
use mozzi::model::description::{Joint, JointKind, Limits, Mimic};
use mozzi::{SE3, Vec3};

/// A joint, and its motion if it has several degrees of freedom.
pub(crate) struct Read {
    pub joint: Joint,
    pub place: Place,
    pub freedoms: Freedoms,
}

/// How a joint moves.
pub(crate) enum Freedoms {
    /// As given by its kind.
    OneOrNone,
    /// As a series of joints of one axis.
    Series(Vec<Part>),
    /// About a point.
    Ball,
    /// In SE(3).
    Six,
}

/// Reads a joint. Invalid parts are reported, and treated as missing.
pub(crate) fn read(element: &Element, cx: &mut Context) -> Read {
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
    let is_drake = element.written_name() == "drake:joint";
    let kind = read_type(&element, is_drake, cx);
    let (axis, limit) = (children.get("axis"), children.get("limit"));
    let [damping, friction, stiffness, spring_reference, armature] = match (kind, is_drake) {
        (Some("planar"), true) => read_dynamics(&children, &["friction"], &mut place, cx),
        _ => read_dynamics(&children, &DYNAMICS_READ.map(|(name, _)| name), &mut place, cx),
    };
    // of a fixed joint, these have no meaning
    let (mut freedoms, mut screw, mut limits) = (Freedoms::OneOrNone, None, Limits::default());
    let series = |parts: Option<Vec<Part>>| parts.map_or(Freedoms::OneOrNone, Freedoms::Series);
    match kind {
        None | Some("fixed") => {}
        Some("floating") => freedoms = Freedoms::Six,
        Some("ball") => freedoms = Freedoms::Ball,
        Some("universal") => {
            drake::check_universal(axis, cx);
            freedoms = series(series::universal(damping));
        }
        Some("planar") => {
            let normal = axis::read("planar", axis, &element, cx);
            let damping = match is_drake {
                true => drake::planar_damping(children.get("dynamics"), cx),
                false => Some([0.0; 3]),
            };
            freedoms = series(normal.zip(damping).and_then(|(normal, d)| series::planar(normal.twist().w, d)));
        }
        Some("screw") => {
            screw = drake::screw(&element, axis, cx);
            limits = limit.map_or(limits, |limit| limit::read("screw", Some(limit), &element, &mut place, cx));
        }
        Some(kind) => {
            screw = axis::read(kind, axis, &element, cx);
            limits = limit::read(kind, limit, &element, &mut place, cx);
        }
    }
    let is_several = matches!(kind, Some("planar" | "floating" | "ball" | "universal"));
    // Drake's ball and universal joints have one damping for all axes
    let is_damped = matches!(kind, Some("ball" | "universal"));
    if let Some(kind) = kind.filter(|_| is_several) {
        let is_rough = [if is_damped { 0.0 } else { damping }, friction, stiffness, armature].iter().any(|x| *x != 0.0);
        several_freedoms(kind, &children, is_rough, &element, cx);
    }
    if let Some(value) = element.attribute("type") {
        place.set("kind", value.span);
    }
    let joint = Joint {
        name,
        parent,
        child,
        origin: origin.unwrap_or_else(SE3::identity),
        kind: match (&freedoms, screw) {
            (Freedoms::Six, _) => JointKind::Free,
            (Freedoms::Ball, _) => JointKind::Ball(Vec3::zero()),
            (_, screw) => screw.map_or(JointKind::Fixed, JointKind::Screw),
        },
        limits,
        damping: if is_several && !is_damped { 0.0 } else { damping },
        friction: if is_several { 0.0 } else { friction },
        armature: if is_several { 0.0 } else { armature },
        stiffness: if is_several { 0.0 } else { stiffness },
        spring_reference: if is_several { 0.0 } else { spring_reference },
        mimic: children.get("mimic").and_then(|mimic| read_mimic(mimic, &mut place, cx)),
    };
    if kind != Some("fixed") && joint.kind == JointKind::Fixed {
        place.report("kind");
    }
    Read { joint, place, freedoms }
}

/// URDF has one number for the limits and the friction of a joint, which is undefined for several degrees of freedom. A
/// mimic relation would be lost as well, and changes the robot.
fn several_freedoms(kind: &str, children: &Children, is_rough: bool, element: &Element, cx: &mut Context) {
    let subject = &element.subject;
    let limit = children.get("limit").filter(|limit| {
        limit.check_attributes(&LIMIT, cx);
        limit.check_children(&LIMIT, cx);
        // every number is read, since each can be invalid
        let numbers: Vec<f64> = LIMIT.attributes.iter().filter_map(|name| limit.number(name, cx)).collect();
        numbers.iter().any(|x| *x != 0.0)
    });
    for given in limit.into_iter().chain(children.get("dynamics").filter(|_| is_rough)) {
        let message = format!(
            "{}: is ignored: a {kind} joint {}",
            given.subject,
            match kind {
                "planar" | "floating" => "slides and turns, in metres and in radians",
                _ => "turns about several axes",
            }
        );
        cx.findings.add(Finding::warning("ignored_property", given.span(), message));
    }
    if let Some(mimic) = children.get("mimic") {
        let message = format!("{subject}: mimic: a {kind} joint has several positions and cannot be a mimic joint");
        let help = "build it from joints of one axis, and make those mimic joints";
        cx.findings.add(Finding::error("unsupported_joint", mimic.span(), message).help(help));
    }
}

/// One of the types of URDF or Drake that mozzi computes; None, with a diagnostic, for others.
fn read_type(element: &Element, is_drake: bool, cx: &mut Context) -> Option<&'static str> {
    let value = element.required("type", cx)?;
    let types: &[&'static str] = if is_drake { &drake::JOINT_TYPES } else { &JOINT_TYPES };
    let known = types.iter().copied().find(|&known| known == value.text);
    if known.is_some() {
        return known;
    }
    let subject = &element.subject;
    cx.findings.add(match value.text {
        "curvilinear" if is_drake => {
            let message =
                format!("{subject}: type: is `curvilinear`, a joint along a curve, which mozzi does not compute");
            Finding::error("unsupported_joint", value.span, message).help("use joints of one axis in its place")
        }
        "ball" | "spherical" if !is_drake => {
            let message = format!("{subject}: type: is `{}`, a ball joint, which URDF does not define", value.text);
            let help = "URDF has no balls; Drake's <drake:joint type=\"ball\"> and MJCF's `ball` are read";
            Finding::error("unsupported_joint", value.span, message).help(help)
        }
        other => {
            let message = format!("{subject}: type: is `{}`, expected one of {}", shown(other), list(types));
            Finding::error("unknown_joint_type", value.span, message)
                .maybe_help(did_you_mean(other, types.iter().copied()))
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

/// The attributes of `<dynamics>`, and their names in the checks.
const DYNAMICS_READ: [(&str, &str); 5] = [
    ("damping", "damping"),
    ("friction", "friction"),
    ("spring_stiffness", "stiffness"),
    ("spring_reference", "spring reference"),
    ("armature", "armature"),
];

/// Damping, friction, and two extensions: a spring with SDF's names, the armature with MJCF's. Only the attributes in
/// `read` are read as single numbers.
fn read_dynamics(children: &Children, read: &[&str], place: &mut Place, cx: &mut Context) -> [f64; 5] {
    let Some(dynamics) = children.get("dynamics") else { return [0.0; 5] };
    dynamics.check_attributes(&DYNAMICS, cx);
    dynamics.check_children(&DYNAMICS, cx);
    DYNAMICS_READ.map(|(name, check)| {
        let Some(value) = dynamics.attribute(name).filter(|_| read.contains(&name)) else { return 0.0 };
        let number = dynamics.vector::<1>(name, &value, cx).map_or(0.0, |[x]| x);
        place.set(check, value.span);
        number
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
