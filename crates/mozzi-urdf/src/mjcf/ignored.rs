//! Model content that does not affect the dynamics: reported once per kind, with the number of occurrences.

use super::attributes::Item;
use crate::report::finding::{Finding, Topic};
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use std::collections::BTreeMap;
use std::ops::Range;

/// MuJoCo's own plugins that apply no force to bodies: sensors, actuators and shapes.
const HARMLESS_PLUGINS: [&str; 3] = ["mujoco.sensor.", "mujoco.pid", "mujoco.sdf."];

/// The first occurrence of a kind, and the number of occurrences.
struct Kind {
    code: &'static str,
    span: Range<usize>,
    message: String,
    help: &'static str,
    count: usize,
    /// For unused content: what it concerns.
    topic: Option<Topic>,
}

/// Everything left out, by kind.
#[derive(Default)]
pub(crate) struct Ignored(BTreeMap<String, Kind>);

impl Ignored {
    fn add(&mut self, kind: &str, first: impl FnOnce() -> Kind) {
        match self.0.get_mut(kind) {
            Some(known) => known.count += 1,
            None => {
                self.0.insert(kind.to_string(), first());
            }
        }
    }

    /// A force that mozzi does not compute.
    pub fn force(&mut self, kind: &str, item: &Item, name: &str, what: &str) {
        self.add(&format!("force {kind}"), || {
            let value = item.value(name);
            let text = value.as_ref().map_or_else(String::new, |value| format!(" is `{}`,", shown(value.text.trim())));
            Kind {
                code: "ignored_force",
                span: value.map_or_else(|| item.element.span(), |value| value.span),
                message: format!("{}: {name}:{text} {what}, which mozzi does not compute", item.element.subject),
                help: "M, c, g and inverse and forward dynamics omit it; add its effect to the joint torques",
                count: 1,
                topic: None,
            }
        });
    }

    /// A mesh in a body that does not move.
    pub fn mesh(&mut self, item: &Item) {
        self.add("mesh", || Kind {
            code: "ignored_mesh",
            span: item.element.span(),
            message: format!("{}: is a mesh of unknown mass; the body does not move", item.element.subject),
            help: "the mass of a body that does not move affects only the total mass",
            count: 1,
            topic: None,
        });
    }

    /// An element that does not affect the dynamics.
    pub fn element(&mut self, element: &Element, parent: &str) {
        self.list(element.name(), element.span(), parent, "it affects appearance only");
    }

    /// Plugins declared with an instance: each may act on bodies that do not name it.
    fn plugins(&mut self, extension: &Element) {
        for plugin in extension.elements() {
            let name = plugin.attribute("plugin").map_or("", |value| value.text);
            let acts = !HARMLESS_PLUGINS.iter().any(|start| name.starts_with(start));
            if acts && plugin.elements().any(|instance| instance.name() == "instance") {
                let item = Item::plain(&plugin.called("extension: plugin"));
                self.force("plugin", &item, "plugin", "a plugin, which may apply forces");
            }
        }
    }

    /// A body or site of the world that does not move, next to a free body.
    pub fn beside(&mut self, what: &str, name: &str, span: Range<usize>, free: &str) {
        self.add(&format!("beside {what}"), || Kind {
            code: "ignored_element",
            span,
            message: format!("{what} `{name}`: does not move, and is ignored next to the free body `{free}`"),
            help: "it acts on the free body by contacts only, which are not computed",
            count: 1,
            topic: Some(Topic::Looks),
        });
    }

    /// One of a kind of elements that are ignored.
    pub fn list(&mut self, name: &str, span: Range<usize>, parent: &str, help: &'static str) {
        let message = || format!("{parent}: <{}> is ignored", shown(name));
        self.add(&format!("element {name}"), || Kind {
            code: "ignored_element",
            span,
            message: message(),
            help,
            count: 1,
            topic: Some(topic_of(name)),
        });
    }

    /// The sections of the model that are ignored.
    pub fn sections(&mut self, sections: &[Element]) {
        for section in sections {
            let help = match section.name() {
                "actuator" => "joint torques are arguments of the functions",
                "contact" => "contacts are not computed; give their forces as applied wrenches",
                "sensor" => "mozzi computes the measured quantities on request",
                "custom" => "it does not affect the dynamics",
                "extension" => "plugins are not computed",
                "size" => "it sets MuJoCo's memory size",
                "asset" => "it affects appearance and contacts, and inertias that are computed from meshes",
                "visual" | "statistic" | "deformable" => "it affects appearance only",
                _ => continue,
            };
            match section.name() {
                "extension" => self.plugins(section),
                // a flex is refused
                "deformable" if section.elements().any(|child| child.name() == "flex") => continue,
                _ => {}
            }
            self.list(section.name(), section.span(), "mujoco", help);
        }
    }

    /// Reports everything left out.
    pub fn tell(&mut self, cx: &mut Context) {
        for ((element, name), span) in std::mem::take(&mut cx.left_out) {
            let message = format!("{element}: `{name}` is ignored");
            cx.findings.add(Finding::unused(topic_of(&element), "ignored_attribute", span, message));
        }
        for (_, kind) in std::mem::take(&mut self.0) {
            let message = match kind.count {
                1 => kind.message,
                count => format!("{} (here, and {} more)", kind.message, count - 1),
            };
            let finding = Finding::warning(kind.code, kind.span, message).help(kind.help);
            cx.findings.add(Finding { topic: kind.topic, ..finding });
        }
    }
}

/// The topic of an unused element, or of an element with an unused attribute.
fn topic_of(element: &str) -> Topic {
    match element {
        "actuator" | "sensor" | "key" => Topic::Actuators,
        "compiler" | "option" | "flag" | "size" | "custom" | "extension" | "connect" | "weld" => Topic::Settings,
        "equality" | "tendon" => Topic::Idle,
        _ => Topic::Looks,
    }
}
