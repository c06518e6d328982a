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
use mozzi::Vec3;
use std::rc::Rc;

/// More copies of one <replicate>, or of those inside each other, are refused.
const MOST_COPIES: usize = 10_000;

/// The surroundings of an element of a body.
#[derive(Clone)]
pub(crate) struct Around {
    /// The frame, relative to the body's.
    pub T: SE3,
    /// The default class.
    pub class: Class,
    pub depth: usize,
    /// The suffix that <replicate> adds to names.
    pub suffix: Rc<str>,
    /// The number of copies that this is one of.
    pub copies: usize,
}

impl Around {
    pub fn new(class: Class) -> Self {
        Around { T: SE3::identity(), class, depth: 0, suffix: "".into(), copies: 1 }
    }
}

/// An element of a body, with the configuration of its frame relative to the body's.
pub(crate) struct Inside<'a> {
    pub item: Item<'a>,
    pub T: SE3,
    /// The surroundings of its contents.
    pub around: Around,
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
    /// Adds the contents of an element.
    pub fn gather(&mut self, element: &Element<'a>, around: &Around, contents: &mut Contents<'a>, cx: &mut Context) {
        let Around { T, class, depth, .. } = *around;
        let inside = |item| Inside { item, T, around: around.clone() };
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
                    list.push(inside(item));
                }
                "body" => contents.bodies.push(inside(Item::plain(&child))),
                "inertial" => contents.inertial = contents.inertial.take().or(Some(Item::plain(&child))),
                "freejoint" => contents.free.push(inside(Item::plain(&child))), // takes no defaults
                "frame" => {
                    child.check_attributes(&vocabulary::FRAME, cx);
                    child.check_children(&vocabulary::FRAME, cx);
                    let class = self.classes.named(&child, "childclass", class, cx);
                    let frame = T * pose(&Item::plain(&child), &self.compiler, cx);
                    let around = Around { T: frame, class, depth: depth + 1, ..around.clone() };
                    self.gather(&child, &around, contents, cx);
                }
                "replicate" => self.replicate(&child, around, contents, cx),
                name @ ("composite" | "flexcomp") => {
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

    /// Copies of the contents: copy i is turned by i times the angles, and is `offset` away from the one before, in the
    /// axes of that one. Names get its number.
    fn replicate(&mut self, element: &Element<'a>, around: &Around, contents: &mut Contents<'a>, cx: &mut Context) {
        element.check_attributes(&vocabulary::REPLICATE, cx);
        element.check_children(&vocabulary::REPLICATE, cx);
        let item = Item::plain(element);
        if element.required("count", cx).is_none() {
            return;
        }
        let given = item.number("count", 0.0, cx);
        let copies = given * around.copies as f64;
        if !(given >= 0.0 && given.fract() == 0.0 && copies <= MOST_COPIES as f64) {
            let message =
                format!("count: is {given}, expected a whole number, and at most {MOST_COPIES} copies in all");
            cx.findings.add(item.error("wrong_count", "count", &message));
            return;
        }
        let class = self.classes.named(element, "childclass", around.class, cx);
        let offset = Vec3(item.vector::<3>("offset", cx).unwrap_or_default());
        let euler = item.vector::<3>("euler", cx).unwrap_or_default();
        let separator = item.value("sep").map_or("", |value| value.text);
        let (digits, mut p) = (given.to_string().len(), Vec3::zero());
        for i in 0..given as usize {
            let R = self.compiler.of(element).euler(euler.map(|angle| i as f64 * angle));
            let T = around.T * SE3 { R, p };
            p += R.matrix() * offset;
            let suffix = format!("{separator}{i:0digits$}{}", around.suffix).into();
            let around = Around { T, class, depth: around.depth + 1, suffix, copies: copies as usize };
            self.gather(element, &around, contents, cx);
        }
    }
}
