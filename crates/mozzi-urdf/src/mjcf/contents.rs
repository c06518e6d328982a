//! The contents of a body, with frames resolved.

use super::Model;
use super::attributes::Item;
use super::class::Class;
use super::depth::is_too_deep;
use super::orientation::pose;
use super::vocabulary;
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::SE3;

/// An element of a body, with the configuration of its frame relative to the body's.
pub(crate) struct Inside<'a> {
    pub item: Item<'a>,
    pub T: SE3,
    /// The default class of its contents.
    pub class: Class,
}

/// The contents of a body, each kind in the order of the file.
#[derive(Default)]
pub(crate) struct Contents<'a> {
    pub joints: Vec<Inside<'a>>,
    /// Free joints.
    pub free: Vec<Inside<'a>>,
    pub geoms: Vec<Inside<'a>>,
    pub sites: Vec<Inside<'a>>,
    pub bodies: Vec<Inside<'a>>,
    pub inertial: Option<Item<'a>>,
}

impl<'a> Model<'a> {
    /// Adds the contents of an element whose frame is at T relative to the body's.
    pub fn gather(
        &mut self,
        element: &Element<'a>,
        T: SE3,
        class: Class,
        depth: usize,
        contents: &mut Contents<'a>,
        cx: &mut Context,
    ) {
        if is_too_deep(element, depth, cx) {
            return;
        }
        for child in element.elements().filter(|child| !child.has_prefix()) {
            if cx.findings.is_full() {
                return;
            }
            match child.name() {
                tag @ ("joint" | "geom" | "site") => {
                    let item = self.classes.item(child, tag, class, cx);
                    let list = match tag {
                        "joint" if item.value("type").is_some_and(|kind| kind.text == "free") => &mut contents.free,
                        "joint" => &mut contents.joints,
                        "geom" => &mut contents.geoms,
                        _ => &mut contents.sites,
                    };
                    list.push(Inside { item, T, class });
                }
                "body" => contents.bodies.push(Inside { item: Item::plain(&child), T, class }),
                "inertial" => contents.inertial = contents.inertial.take().or(Some(Item::plain(&child))),
                "freejoint" => contents.free.push(Inside { item: Item::plain(&child), T, class }), // takes no defaults
                "frame" => {
                    child.check_attributes(&vocabulary::FRAME, cx);
                    child.check_children(&vocabulary::FRAME, cx);
                    let class = self.classes.named(&child, "childclass", class, cx);
                    let frame = T * pose(&Item::plain(&child), &self.compiler, cx);
                    self.gather(&child, frame, class, depth + 1, contents, cx);
                }
                name @ ("replicate" | "attach" | "composite" | "flexcomp") => {
                    let message = format!("{}: has <{name}>, which mozzi does not expand", element.subject);
                    let help = "let MuJoCo expand it: load the model there and save it as XML";
                    cx.findings.add(Finding::error("unsupported_element", child.span(), message).help(help));
                }
                "camera" | "light" => self.ignored.element(&child, &element.subject),
                "plugin" => self.ignored.force("plugin", &Item::plain(&child), "plugin", "a plugin"),
                _ => {}
            }
        }
    }
}
