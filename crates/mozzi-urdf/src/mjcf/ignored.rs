//! What of a model does not enter the dynamics: said once per kind, with how often it stands there.

use super::attributes::Item;
use crate::context::{Context, LeftOut};
use crate::element::Element;
use crate::finding::Finding;
use crate::vocabulary::{list, shown};
use std::collections::BTreeMap;
use std::ops::Range;

/// MuJoCo's own plugins that put no force on bodies: they measure, they are actuators, or they are shapes.
const HARMLESS_PLUGINS: [&str; 3] = ["mujoco.sensor.", "mujoco.pid", "mujoco.sdf."];

/// The first of a kind, and how many there are.
struct Kind {
    code: &'static str,
    span: Range<usize>,
    message: String,
    help: &'static str,
    count: usize,
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
                help: "M, c, g and inverse and forward dynamics leave it out; add what it does to the joints' torques",
                count: 1,
            }
        });
    }

    /// A mesh in a body that does not move.
    pub fn mesh(&mut self, item: &Item) {
        self.add("mesh", || Kind {
            code: "ignored_mesh",
            span: item.element.span(),
            message: format!("{}: is a mesh, whose mass is not known; the body does not move", item.element.subject),
            help: "the mass of what does not move enters nothing but the sum of masses",
            count: 1,
        });
    }

    /// An element that says nothing about dynamics.
    pub fn element(&mut self, element: &Element, parent: &str) {
        self.list(element.name(), element.span(), parent, "it is for the eye only");
    }

    /// The plugins that are declared with an instance: each may act on bodies without being named there again.
    fn plugins(&mut self, extension: &Element) {
        for plugin in extension.elements() {
            let name = plugin.attribute("plugin").map_or("", |value| value.text);
            let acts = !HARMLESS_PLUGINS.iter().any(|start| name.starts_with(start));
            if acts && plugin.elements().any(|instance| instance.name() == "instance") {
                let item = Item::plain(&plugin.called("extension: plugin"));
                self.force("plugin", &item, "plugin", "a plugin, whose forces are its own");
            }
        }
    }

    /// Where a free body is at first.
    pub fn start(&mut self, body: &Element) {
        self.add("start", || Kind {
            code: "ignored_element",
            span: body.span(),
            message: format!("{}: the pose in which it starts is ignored", body.subject),
            help: "states are given to the functions; the positions of a free body are its pose in the world, as MuJoCo's are",
            count: 1,
        });
    }

    /// What stands in the world beside a free body, and does not move either.
    pub fn beside(&mut self, what: &str, name: &str, span: Range<usize>, free: &str) {
        self.add(&format!("beside {what}"), || Kind {
            code: "ignored_element",
            span,
            message: format!("{what} `{name}`: does not move, and is ignored beside the free body `{free}`"),
            help: "it touches the free body by contacts alone, which are not computed",
            count: 1,
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
        });
    }

    /// The sections of the model that are ignored.
    pub fn sections(&mut self, sections: &[Element]) {
        for section in sections {
            let help = match section.name() {
                "actuator" => "the joints' torques are given to the functions",
                "contact" => "contacts are not computed; give their forces as applied wrenches",
                "sensor" => "everything that a sensor measures can be asked for",
                "keyframe" => "states are given to the functions",
                "custom" => "it says nothing about dynamics",
                "extension" => "plugins are not computed",
                "size" => "it is memory for MuJoCo",
                "asset" => {
                    "it is for the eye and for contacts; a mesh whose inertia is needed is refused where it is used"
                }
                "visual" | "statistic" | "deformable" => "it is for the eye only",
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

    /// Says all of it.
    pub fn tell(&mut self, cx: &mut Context) {
        for (element, LeftOut { span, names }) in std::mem::take(&mut cx.left_out) {
            let names: Vec<&str> = names.into_iter().collect();
            let are = if names.len() == 1 { "is" } else { "are" };
            let message = format!("{element}: {} {are} ignored", list(&names));
            cx.findings.add(Finding::warning("ignored_attribute", span, message));
        }
        for (_, kind) in std::mem::take(&mut self.0) {
            let message = match kind.count {
                1 => kind.message,
                count => format!("{} (here, and {} more)", kind.message, count - 1),
            };
            cx.findings.add(Finding::warning(kind.code, kind.span, message).help(kind.help));
        }
    }
}
