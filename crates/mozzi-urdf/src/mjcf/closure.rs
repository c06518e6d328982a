//! `<equality>`, `<tendon>` and `<actuator>`: what couples joints or closes loops. An affine coupling of two joints is a
//! mimic joint; the rest is refused by name, unless it has no effect on the dynamics.

use super::Model;
use super::attributes::Item;
use super::class::{Class, MOST_SUGGESTED};
use super::vocabulary;
use crate::context::Context;
use crate::element::Element;
use crate::finding::Finding;
use crate::spelling::did_you_mean;
use crate::vocabulary::shown;
use mozzi::model::description::Mimic;
use std::collections::BTreeMap;

impl<'a> Model<'a> {
    /// Everything outside the tree of bodies that could act on it.
    pub fn closures(&mut self, sections: &[Element<'a>], cx: &mut Context) {
        let names: BTreeMap<String, usize> = (self.tree.joints.iter().enumerate())
            .filter_map(|(i, joint)| Some((joint.name.given.clone()?, i)))
            .collect();
        for section in sections {
            match section.name() {
                "equality" => section.check_children(&vocabulary::EQUALITY, cx),
                "tendon" => section.check_children(&vocabulary::TENDONS, cx),
                _ => continue,
            };
        }
        for (section, child) in
            sections.iter().flat_map(|section| section.elements().map(move |child| (section, child)))
        {
            if cx.findings.is_full() {
                return;
            }
            let name = child.attribute("name").map_or_else(String::new, |name| format!(" `{}`", shown(name.text)));
            let child = child.called(format!("{}: {}{name}", section.name(), child.name()));
            match section.name() {
                "equality" => self.equality(child, &names, cx),
                "tendon" => self.tendon(child, cx),
                "actuator" => self.actuator(child, cx),
                "deformable" if child.name() == "flex" => {
                    let message = format!("{}: is a flexible body, which mozzi does not compute", child.subject);
                    cx.findings.add(Finding::error("unsupported_element", child.span(), message));
                }
                _ => {}
            }
        }
    }

    fn equality(&mut self, element: Element<'a>, names: &BTreeMap<String, usize>, cx: &mut Context) {
        if !vocabulary::EQUALITY.many.contains(&element.name()) {
            return; // which was said
        }
        let item = self.classes.item(element, "equality", Class::MAIN, cx);
        let name = item.element.name();
        if !self.options.equality || !item.flag("active", true, cx) {
            self.ignored.list("equality", item.element.span(), "mujoco", "it is not active");
            return;
        }
        if name != "joint" {
            let code = if matches!(name, "connect" | "weld") { "loop_closure" } else { "unsupported_equality" };
            let what = match name {
                "connect" | "weld" => "ties two bodies, which closes a loop",
                "tendon" => "ties tendons",
                _ => "ties a flexible body",
            };
            let message = format!("{}: {what}, which mozzi does not compute", item.element.subject);
            let help = "remove it, or set active=\"false\", if the tree without it is what you want to compute";
            cx.findings.add(Finding::error(code, item.element.span(), message).help(help));
            return;
        }
        item.element.check_attributes(&vocabulary::COUPLING, cx);
        self.coupling(&item, names, cx);
    }

    /// y − y₀ = a₀ + a₁ (x − x₀) makes y a mimic joint of x.
    fn coupling(&mut self, item: &Item<'a>, names: &BTreeMap<String, usize>, cx: &mut Context) {
        let mut polynomial = item.overlaid::<5>("polycoef", cx);
        if !item.has("polycoef") {
            polynomial = [0.0, 1.0, 0.0, 0.0, 0.0];
        }
        let [a0, a1, curved @ ..] = polynomial;
        let subject = &item.element.subject;
        let refuse = |what: &str| {
            let message = format!("{subject}: {what}");
            let help = "expected a coupling of two joints by a straight line, polycoef=\"a b 0 0 0\"";
            Finding::error("unsupported_equality", item.element.span(), message).help(help)
        };
        let mut find = |attribute: &str| {
            let value = item.element.required(attribute, cx)?;
            let found = names.get(value.text).copied();
            if found.is_none() {
                let message = format!("{subject}: {attribute}: there is no joint `{}`", shown(value.text));
                let help = did_you_mean(value.text, names.keys().map(String::as_str).take(MOST_SUGGESTED));
                cx.findings.add(Finding::error("unknown_joint", value.span.clone(), message).maybe_help(help));
            }
            found.map(|found| (found, value))
        };
        let mimic_joint = find("joint1");
        if item.element.attribute("joint2").is_none() {
            cx.findings.add(refuse("holds a joint where it is, which mozzi does not compute"));
            return;
        }
        let (Some((y, _)), Some((x, source))) = (mimic_joint, find("joint2")) else { return };
        if curved != [0.0; 3] {
            cx.findings.add(refuse("couples joints by a curve, which mozzi does not compute"));
            return;
        }
        if self.tree.joints[y].joint.mimic.is_some() {
            cx.findings.add(refuse("its joint1 follows another already, expected one that it follows"));
            return;
        }
        let offset = self.tree.joints[y].reference + a0 - a1 * self.tree.joints[x].reference;
        let joint = &mut self.tree.joints[y];
        joint.place.set("mimic", source.span);
        joint.joint.mimic = Some(Mimic { joint: source.text.to_string(), ratio: a1, offset });
    }

    /// A tendon that only transmits the force of an actuator has no effect of its own.
    fn tendon(&mut self, element: Element<'a>, cx: &mut Context) {
        if !vocabulary::TENDONS.many.contains(&element.name()) {
            return; // which was said
        }
        let item = self.classes.item(element, "tendon", Class::MAIN, cx);
        item.element.check_attributes(&vocabulary::TENDON, cx);
        let force = ["stiffness", "damping"].into_iter().find(|name| item.overlaid::<3>(name, cx) != [0.0; 3]);
        let more = ["frictionloss", "armature"].into_iter().find(|name| item.number(name, 0.0, cx) != 0.0);
        let limited = item.word("limited", &["auto", "true", "false"], cx).unwrap_or("auto");
        let is_limited = limited == "true" || limited == "auto" && item.has("range") && self.compiler.autolimits;
        let Some(name) = force.or(more).or(is_limited.then_some("range")) else {
            let help = "without stiffness, damping, friction, armature and limits it acts on nothing";
            self.ignored.list("tendon", item.element.span(), "mujoco", help);
            return;
        };
        let what = if name == "range" { "is limited" } else { "has a force of its own" };
        let message = format!("{name}: the tendon {what}, which mozzi does not compute");
        let help = "remove it if the tree without it is what you want to compute";
        cx.findings.add(item.error("unsupported_tendon", name, &message).help(help));
    }

    /// The torques of actuators are arguments; their rotors and dampers are not.
    fn actuator(&mut self, element: Element<'a>, cx: &mut Context) {
        let item = self.classes.item(element, "actuator", Class::MAIN, cx);
        if item.number("armature", 0.0, cx) != 0.0 {
            let message = "armature: is an inertia of the actuator, which mozzi does not add to its joint's";
            let help = "give the joint the armature, times the square of the gear";
            cx.findings.add(item.error("actuator_armature", "armature", message).help(help));
        }
        if item.overlaid::<3>("damping", cx) != [0.0; 3] {
            self.ignored.force("actuator damping", &item, "damping", "a damping of the actuator");
        }
    }
}
