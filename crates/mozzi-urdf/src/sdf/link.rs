//! `<link>` and its `<inertial>`.

use super::graph::{Node, Scope, What};
use super::part::Part;
use super::pose::Pose;
use super::version::Version;
use super::vocabulary::{FRAME, INERTIA, INERTIAL, LINK};
use super::{Reader, full_name};
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::linalg::Sym3;
use mozzi::{SE3, SpatialInertia, Vec3};
use std::rc::Rc;

/// A link; its node has its place.
pub(crate) struct Link {
    pub name: String,
    pub node: usize,
    pub inertia: SpatialInertia,
    pub place: Place,
}

/// A `<frame>`.
pub(crate) struct Frame {
    pub name: String,
    pub node: usize,
    pub place: Place,
}

impl<'a> Reader<'a> {
    pub fn link(&mut self, element: &Element<'a>, scope: &Rc<Scope>, version: Version, cx: &mut Context) {
        let mut place = Place::new(element.span());
        let value = element.called("link").required_name("name", cx);
        let name = full_name(scope, &place.note("name", value));
        let element = element.called(format!("link `{}`", crate::urdf::vocabulary::shown(&name)));
        let before = cx.findings.errors();
        let part = Part::new(element, &LINK, cx);
        if cx.findings.errors() > before {
            ["mass", "inertia"].into_iter().for_each(|attribute| place.report(attribute));
        }
        let subject = part.element.subject.clone();
        for (word, acts, what) in [
            ("gravity", !part.flag("gravity", true, cx), "switches gravity off for this link"),
            ("kinematic", part.flag("kinematic", false, cx), "prescribes the motion of this link"),
            ("velocity_decay", decays(&part, cx), "damps the motion of this link"),
        ] {
            if acts {
                let message = format!("{subject}: {word}: {what} in Gazebo, which mozzi does not compute");
                cx.repeat(&format!("link {word}"), Finding::warning("ignored_force", part.span(word), message));
            }
        }
        self.plugins(&part.element, cx);
        let inertia = match part.child("inertial") {
            Some(inertial) => read_inertial(inertial, version, &mut place, cx),
            None => {
                let message = format!("{subject}: has no <inertial>: SDFormat gives it 1 kg and moments of 1 kg m²");
                cx.findings.add(Finding::warning("default_inertia", part.element.span(), message));
                SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(1.0, 1.0, 1.0))
            }
        };
        let pose = Pose::of(&part, version, cx);
        let node = Node {
            T: pose.T,
            relative_to: pose.relative_to,
            ..Node::new(What::Link(self.links.len()), scope, subject)
        };
        let node = self.named(&name, node, &place, version, cx);
        self.first_link(scope.model, self.links.len());
        self.first_link(scope.frame, self.links.len());
        self.links.push(Link { name, node, inertia, place });
    }

    pub fn frame(&mut self, element: &Element<'a>, scope: &Rc<Scope>, version: Version, cx: &mut Context) {
        let mut place = Place::new(element.span());
        let value = element.called("frame").required_name("name", cx);
        let name = full_name(scope, &place.note("name", value));
        let subject = format!("frame `{}`", crate::urdf::vocabulary::shown(&name));
        let part = Part::new(element.called(subject.clone()), &FRAME, cx);
        let pose = Pose::of(&part, version, cx);
        let carrier = part.element.attribute("attached_to").filter(|value| !value.text.is_empty());
        let relative_to = pose.relative_to.or_else(|| carrier.clone());
        let node = Node { T: pose.T, relative_to, carrier, ..Node::new(What::Frame, scope, subject) };
        let node = self.named(&name, node, &place, version, cx);
        self.frames.push(Frame { name, node, place });
    }

    /// Adds a named node; reports a name that something else in the model has.
    pub fn named(&mut self, name: &str, node: Node<'a>, place: &Place, version: Version, cx: &mut Context) -> usize {
        let (subject, node) = (node.subject.clone(), self.graph.add(node));
        if !self.graph.name(name, node) && version >= Version::WITH_FRAMES {
            let message =
                format!("{subject}: the name is used twice, expected one for each link, joint, frame and model");
            cx.findings.add(Finding::error("duplicate_name", place.span("name"), message).help("rename one of them"));
        }
        node
    }

    /// Records the first link of a model.
    pub fn first_link(&mut self, model: usize, link: usize) {
        let node = self.graph.node(model);
        if node.what == What::Model(None) {
            node.what = What::Model(Some(link));
        }
    }
}

/// True if a rate of `velocity_decay` is not 0.
fn decays(part: &Part, cx: &mut Context) -> bool {
    let Some(decay) = part.child("velocity_decay") else { return false };
    decay.elements().any(|rate| decay.vector::<1>(rate.name(), &rate.content(), cx).is_some_and(|[x]| x != 0.0))
}

/// The inertia in the link's frame.
fn read_inertial(element: &Element, version: Version, place: &mut Place, cx: &mut Context) -> SpatialInertia {
    let part = Part::new(element.clone(), &INERTIAL, cx);
    let auto = element.attribute("auto").and_then(|value| super::part::truth(element, "auto", &value, cx));
    if auto == Some(true) {
        let message = format!("{}: auto: is `true`: the inertia is to be computed from shapes", element.subject);
        let help = "write <mass> and <inertia>; `mozzi check --estimate-inertia` proposes them for a URDF";
        let span = element.attribute("auto").map_or_else(|| element.span(), |value| value.span);
        cx.findings.add(Finding::error("inertia_from_shapes", span, message).help(help));
        ["mass", "inertia"].into_iter().for_each(|attribute| place.report(attribute));
    }
    if let Some(fluid) = part.child("fluid_added_mass") {
        let message = format!("{}: is the inertia of a fluid, which mozzi does not compute", fluid.subject);
        cx.repeat("fluid", Finding::warning("ignored_force", fluid.span(), message));
    }
    let pose = Pose::of(&part, version, cx);
    if let Some(frame) = pose.relative_to.filter(|_| version >= Version::WITH_FRAMES) {
        let message =
            format!("{}: pose: relative_to: is not allowed, since it is relative to the link", element.subject);
        cx.findings.error("unsupported_attribute", frame.span, message);
    }
    if part.child("mass").is_none() && auto != Some(true) {
        let message = format!("{}: has no <mass>: SDFormat gives it 1 kg", element.subject);
        cx.findings.add(Finding::warning("default_inertia", element.span(), message));
    }
    let mass = part.number("mass", 1.0, cx);
    place.set("mass", part.span("mass"));
    let mut I = Sym3::diagonal(1.0, 1.0, 1.0);
    match part.child("inertia") {
        Some(inertia) => {
            place.set("inertia", inertia.span());
            let moments = Part::new(inertia.clone(), &INERTIA, cx);
            let missing: Vec<&str> =
                ["ixx", "iyy", "izz"].into_iter().filter(|name| moments.child(name).is_none()).collect();
            if !missing.is_empty() {
                let message =
                    format!("{}: has no <{}>: SDFormat gives it 1 kg m²", inertia.subject, missing.join(">, <"));
                cx.findings.add(Finding::warning("default_inertia", inertia.span(), message));
            }
            let [xx, xy, xz, yy, yz, zz] =
                [("ixx", 1.0), ("ixy", 0.0), ("ixz", 0.0), ("iyy", 1.0), ("iyz", 0.0), ("izz", 1.0)]
                    .map(|(name, default)| moments.number(name, default, cx));
            I = Sym3 { xx, xy, xz, yy, yz, zz };
        }
        None if auto != Some(true) => {
            let message = format!("{}: has no <inertia>: SDFormat gives it moments of 1 kg m²", element.subject);
            cx.findings.add(Finding::warning("default_inertia", element.span(), message));
        }
        None => {}
    }
    let SE3 { R, p } = pose.T;
    place.turned = Some(R);
    SpatialInertia::new(mass, p, I.congruence(R.matrix()))
}
