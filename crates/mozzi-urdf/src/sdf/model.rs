//! `<model>` and `<include>`.

use super::Reader;
use super::assemble::Closure;
use super::graph::{Node, Scope, What};
use super::part::Part;
use super::pose::Pose;
use super::version::Version;
use super::vocabulary::{INCLUDE, MODEL, SDF};
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use std::rc::Rc;

/// Files that include each other are followed to this depth, and to this number of models.
const DEEPEST: usize = 32;
const MOST_MODELS: usize = 1024;

/// An `<include>`, and the version of its file.
pub(super) struct Including<'i, 'a> {
    part: &'i Part<'a>,
    version: Version,
}

impl<'a> Reader<'a> {
    /// A model in another, in the world, or alone. The links of the robot have names without the model's name.
    pub fn model(
        &mut self,
        element: &Element<'a>,
        outer: &Rc<Scope>,
        version: Version,
        over: Option<&Including<'_, 'a>>,
        is_robot: bool,
        cx: &mut Context,
    ) -> Option<String> {
        let mut place = Place::new(element.span());
        let given = over.and_then(|over| over.part.value("name")).filter(|name| !name.text.is_empty());
        let value = given.or_else(|| element.called("model").required_name("name", cx));
        let name = place.note("name", value);
        let subject = format!("model `{}`", shown(&name));
        let part = Part::new(element.called(subject.clone()), &MODEL, cx);
        let is_static = part.flag("static", false, cx) || over.is_some_and(|over| over.part.flag("static", false, cx));
        if is_static {
            let message = format!("{subject}: is static: none of its links moves");
            cx.findings.add(Finding::error("static_model", part.span("static"), message));
        }
        let is_merged = over.is_some_and(|over| {
            let merge = over.part.element.attribute("merge");
            merge.and_then(|value| super::part::truth(&over.part.element, "merge", &value, cx)).unwrap_or(false)
        });
        let pose = match over.filter(|over| over.part.child("pose").is_some()) {
            Some(over) => Pose::of(over.part, over.version, cx),
            None => Pose::of(&part, version, cx),
        };
        let placement = over
            .and_then(|over| over.part.value("placement_frame"))
            .or_else(|| part.element.attribute("placement_frame"))
            .filter(|value| !value.text.is_empty());
        let node =
            Node { T: pose.T, relative_to: pose.relative_to, ..Node::new(What::Model(None), outer, subject.clone()) };
        let node = match is_robot || is_merged {
            true => self.graph.add(node),
            false => self.named(&format!("{}{name}", outer.prefix), node, &place, Version::WITH_FRAMES, cx),
        };
        let inner = Rc::new(match (is_merged, is_robot) {
            (true, _) => Scope { prefix: outer.prefix.clone(), frame: node, model: outer.model },
            (_, true) => Scope { prefix: String::new(), frame: node, model: node },
            _ => Scope { prefix: format!("{}{name}::", outer.prefix), frame: node, model: node },
        });
        if is_robot {
            self.graph.robot = Some((name.clone(), node));
        }
        match placement {
            Some(frame) if is_merged => {
                let message = format!("{subject}: placement_frame: is not read of a model that is merged");
                cx.findings.error("unsupported_attribute", frame.span, message);
            }
            Some(frame) => self.graph.node(node).placement = Some((frame, inner.clone())),
            None => {}
        }
        self.contents(&part.element, &inner, version, cx);
        self.plugins(&part.element, cx);
        let canonical = part.element.attribute("canonical_link").filter(|value| !value.text.is_empty());
        if let Some(link) = canonical {
            let found = self.graph.found(&inner, &link, &format!("{subject}: canonical_link"), cx);
            if let Some(What::Link(link)) = found.map(|found| self.graph.node(found).what) {
                self.graph.node(node).what = What::Model(Some(link));
            }
        }
        if let What::Model(Some(link)) = self.graph.node(node).what {
            self.first_link(outer.frame, link);
        }
        Some(name)
    }

    /// Links, joints, frames and models inside of a model or the world.
    pub fn contents(&mut self, element: &Element<'a>, scope: &Rc<Scope>, version: Version, cx: &mut Context) {
        for child in element.elements() {
            if cx.findings.is_full() {
                return;
            }
            match child.written_name() {
                "link" => self.link(&child, scope, version, cx),
                "joint" | "drake:joint" => self.joint(&child, scope, version, cx),
                "frame" => self.frame(&child, scope, version, cx),
                "model" if scope.model != 0 => {
                    self.model(&child, scope, version, None, false, cx);
                }
                "include" if scope.model != 0 => {
                    self.include(&child, scope, version, false, cx);
                }
                "drake:ball_constraint" => self.closures.extend(Closure::read(&child, scope, cx)),
                _ => {}
            }
        }
    }

    /// A model from another file. Returns its name.
    pub fn include(
        &mut self,
        element: &Element<'a>,
        scope: &Rc<Scope>,
        version: Version,
        is_robot: bool,
        cx: &mut Context,
    ) -> Option<String> {
        let part = Part::new(element.clone(), &INCLUDE, cx);
        let &page = self.includes.get(&element.span().start)?;
        self.plugins(&part.element, cx);
        self.instances += 1;
        if self.depth >= DEEPEST || self.instances > MOST_MODELS {
            let message = format!(
                "{}: more than {DEEPEST} files inside each other or {MOST_MODELS} models, expected at most these",
                element.subject
            );
            if !cx.findings.has_errors() {
                cx.findings.error("too_large", element.span(), message);
            }
            return None;
        }
        let root = Element::root_of(self.pages, page, "sdf")?;
        let own = Version::read(&root, cx);
        root.check_attributes(&SDF, cx);
        let mut models = root.elements().filter(|child| child.name() == "model" && !child.has_prefix());
        let (Some(model), None) = (models.next(), models.next()) else {
            let message = format!("{}: its file has not one <model>", element.subject);
            cx.findings.add(Finding::error("include", part.span("uri"), message).help("name a file of one model"));
            return None;
        };
        self.depth += 1;
        let name = self.model(&model, scope, own, Some(&Including { part: &part, version }), is_robot, cx);
        self.depth -= 1;
        name
    }
}
