//! `<equality>`: what couples joints or closes loops, and the order of what couples them otherwise. An affine coupling
//! of two joints is a mimic joint; the rest is refused by name, unless it has no effect on the dynamics.

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
        let all = |is_first: bool| {
            // actuators move tendons, so these come first
            let sections = sections.iter().filter(move |section| (section.name() != "actuator") == is_first);
            sections.flat_map(|section| section.elements().map(move |child| (section, child)))
        };
        for (section, child) in all(true).chain(all(false)) {
            if cx.findings.is_full() {
                return;
            }
            let name = child.attribute("name").map_or_else(String::new, |name| format!(" `{}`", shown(name.text)));
            let child = child.called(format!("{}: {}{name}", section.name(), child.name()));
            match section.name() {
                "equality" => self.equality(child, &names, cx),
                "tendon" => self.tendon(child, &names, cx),
                "actuator" => self.actuator(child, &names, cx),
                "deformable" if child.name() == "flex" => {
                    let message = format!("{}: is a flexible body, which mozzi does not compute", child.subject);
                    cx.findings.add(Finding::error("unsupported_element", child.span(), message));
                }
                _ => {}
            }
        }
        self.settle_rotors(&names);
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
            let help = "remove it, or set active=\"false\", if you want to compute the tree without it";
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
            let help = "expected a linear coupling of two joints, polycoef=\"a b 0 0 0\"";
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
            cx.findings.add(refuse("fixes a joint at its position, which mozzi does not compute"));
            return;
        }
        let (Some((y, _)), Some((x, source))) = (mimic_joint, find("joint2")) else { return };
        if curved != [0.0; 3] {
            cx.findings.add(refuse("couples joints nonlinearly, which mozzi does not compute"));
            return;
        }
        if self.tree.joints[y].joint.mimic.is_some() {
            cx.findings.add(refuse("its joint1 is already a mimic joint, expected at most one coupling per joint"));
            return;
        }
        let offset = self.tree.joints[y].reference + a0 - a1 * self.tree.joints[x].reference;
        let joint = &mut self.tree.joints[y];
        joint.place.set("mimic", source.span);
        joint.joint.mimic = Some(Mimic { joint: source.text.to_string(), ratio: a1, offset });
    }
}
