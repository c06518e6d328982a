//! The inertia of `<tendon>` and `<actuator>`. A fixed tendon is a rotor that its joints turn; an actuator's inertia is
//! added to its joint or tendon. Other forces of tendons are refused by name.

use super::Model;
use super::attributes::Item;
use super::class::{Class, MOST_SUGGESTED};
use super::law;
use super::tree::{Name, Rotor};
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::model::description::Gear;
use std::collections::BTreeMap;

impl<'a> Model<'a> {
    /// Reads a tendon as a rotor, also one without armature. Joints turn only a fixed tendon at constant ratios, so
    /// others have no gears.
    pub fn tendon(&mut self, element: Element<'a>, names: &BTreeMap<String, usize>, cx: &mut Context) {
        if !vocabulary::TENDONS.many.contains(&element.name()) {
            return; // already reported
        }
        let is_fixed = element.name() == "fixed";
        let item = self.classes.item(element, "tendon", Class::MAIN, cx);
        item.element.check_attributes(&vocabulary::TENDON, cx);
        let armature = item.number("armature", 0.0, cx);
        let force = self.force_of_tendon(&item, armature != 0.0 && !is_fixed, cx);
        if let Some((name, what)) = force {
            let message = format!("{name}: the tendon {what}, which mozzi does not compute");
            let help = "remove it, if you want to compute the tree without it";
            cx.findings.add(item.error("unsupported_tendon", name, &message).help(help));
        }
        let is_limited = self.is_limited(&item, cx);
        if is_limited {
            let message = format!("{}: its limits are ignored", item.element.subject);
            let help = "limits do not enter the dynamics; MuJoCo applies a force beyond them";
            let span = item.value("range").map_or_else(|| item.element.span(), |value| value.span);
            cx.repeat("tendon limits", Finding::warning("ignored_limit", span, message).help(help));
        }
        let mut place = Place::new(item.element.span());
        if let Some(value) = item.value("armature") {
            place.set("armature", value.span);
        }
        let gears = if is_fixed { gears(&item, names, cx) } else { Vec::new() };
        let name = Name::of(&item.element, format!("tendon{}", self.tree.rotors.len()), cx);
        self.tree.rotors.push(Rotor {
            name,
            armature,
            gears,
            is_fixed,
            is_refused: force.is_some(),
            is_limited,
            clamps: item.element.attribute("actuatorfrcrange").is_some(),
            is_tied: false,
            place,
        });
    }

    /// The attribute of a tendon's unsupported effect, and a description of it.
    fn force_of_tendon(&self, item: &Item, is_moved: bool, cx: &mut Context) -> Option<(&'static str, &'static str)> {
        let force = ["stiffness", "damping"].into_iter().find(|name| item.overlaid::<3>(name, cx) != [0.0; 3]);
        let friction = (item.number("frictionloss", 0.0, cx) != 0.0).then_some("frictionloss");
        let force = force.or(friction).map(|name| (name, "has a force of its own"));
        let armature = is_moved.then_some(("armature", "has an inertia that varies with the joints"));
        force.or(armature)
    }

    fn is_limited(&self, item: &Item, cx: &mut Context) -> bool {
        let limited = item.word("limited", &["auto", "true", "false"], cx).unwrap_or("auto");
        limited == "true" || limited == "auto" && item.has("range") && self.compiler.of(&item.element).autolimits
    }

    /// Reads the rotors and dampers of actuators; their torques are arguments of the functions.
    pub fn actuator(&mut self, element: Element<'a>, names: &BTreeMap<String, usize>, cx: &mut Context) {
        let item = self.classes.item(element, "actuator", Class::MAIN, cx);
        item.element.check_attributes(&law::ANY_ACTUATOR, cx);
        self.drive(&item, names, cx);
        if item.overlaid::<3>("damping", cx) != [0.0; 3] {
            self.ignored.force("actuator damping", &item, "damping", "damping of the actuator");
        }
        let armature = item.number("armature", 0.0, cx);
        if armature == 0.0 {
            return;
        }
        let [gear, ..] = if item.has("gear") { item.overlaid::<6>("gear", cx) } else { [1.0; 6] };
        let more = gear * gear * armature;
        let joint = ["joint", "jointinparent"].into_iter().find_map(|name| Some((name, item.element.attribute(name)?)));
        let tendon = item.element.attribute("tendon").map(|value| ("tendon", value));
        let Some((attribute, value)) = joint.or(tendon) else {
            let message = "armature: is the inertia of an actuator that drives neither a joint nor a tendon";
            let help = "give it a `joint` or a `tendon`, or remove the armature";
            cx.findings.add(item.error("actuator_armature", "armature", message).help(help));
            return;
        };
        if attribute != "tendon" {
            match names.get(value.text) {
                Some(&joint) => self.tree.joints[joint].joint.armature += more,
                None => unknown(&item, attribute, "joint", value.text, value.span, names.keys(), cx),
            }
            return;
        }
        match self.tree.rotors.iter_mut().find(|rotor| rotor.name.given.as_deref() == Some(value.text)) {
            Some(rotor) if rotor.is_fixed => rotor.armature += more,
            Some(_) => {
                let message = "armature: acts through a spatial tendon, whose effective inertia varies with the joints";
                let help = "remove it, if you want to compute the tree without it";
                cx.findings.add(item.error("unsupported_tendon", "armature", message).help(help));
            }
            None => {
                let known: Vec<&String> =
                    self.tree.rotors.iter().filter_map(|rotor| rotor.name.given.as_ref()).collect();
                unknown(&item, attribute, "tendon", value.text, value.span, known.into_iter(), cx);
            }
        }
    }

    /// Drops tendons without inertia. The inertia of a tendon of one joint becomes the joint's armature.
    pub fn settle_rotors(&mut self, names: &BTreeMap<String, usize>) {
        for rotor in std::mem::take(&mut self.tree.rotors) {
            match *rotor.gears.as_slice() {
                _ if rotor.is_refused || rotor.armature == 0.0 && (rotor.is_limited || rotor.is_tied) => {}
                _ if rotor.armature == 0.0 => {
                    let help = "without stiffness, damping, friction, armature and limits it has no effect";
                    self.ignored.list("tendon", rotor.place.span(""), "mujoco", help);
                }
                [Gear { ref joint, ratio }] if names.contains_key(joint) => {
                    self.tree.joints[names[joint]].joint.armature += ratio * ratio * rotor.armature;
                }
                [] => {} // already reported
                _ => self.tree.rotors.push(rotor),
            }
        }
    }
}

/// The joints of a fixed tendon.
fn gears(item: &Item, names: &BTreeMap<String, usize>, cx: &mut Context) -> Vec<Gear> {
    let subject = &item.element.subject;
    let mut gears = Vec::new();
    for joint in item.element.elements().filter(|child| child.name() == "joint") {
        let joint = Item::plain(&joint.called(format!("{subject}: joint")));
        let ratio = joint.number("coef", 0.0, cx);
        let Some(value) = joint.element.required("joint", cx) else { continue };
        if !names.contains_key(value.text) {
            unknown(&joint, "joint", "joint", value.text, value.span, names.keys(), cx);
        } else if gears.iter().any(|gear: &Gear| gear.joint == value.text) {
            let message =
                format!("{subject}: joint: `{}` occurs twice, expected one `coef` for each joint", value.text);
            cx.findings.add(Finding::error("duplicate_name", value.span, message));
        } else {
            gears.push(Gear { joint: value.text.to_string(), ratio });
        }
    }
    if item.element.elements().all(|child| child.name() != "joint") {
        let message = "has no joints, expected those that it acts on";
        cx.findings
            .add(item.error("missing_element", "", message).help("write <joint joint=\"…\" coef=\"…\"/> inside"));
    }
    gears
}

/// There is no joint or tendon of this name.
fn unknown<'n>(
    item: &Item,
    attribute: &str,
    what: &str,
    name: &str,
    span: std::ops::Range<usize>,
    known: impl Iterator<Item = &'n String>,
    cx: &mut Context,
) {
    let message = format!("{}: {attribute}: there is no {what} `{}`", item.element.subject, shown(name));
    let help = did_you_mean(name, known.map(String::as_str).take(MOST_SUGGESTED));
    cx.findings.add(Finding::error("unknown_joint", span, message).maybe_help(help));
}
