//! Elements outside the tree of bodies that act on it: equalities, tendons, actuators, flexible bodies, in this order.

use super::Model;
use super::equality::Named;
use super::vocabulary;
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use std::collections::BTreeMap;

impl<'a> Model<'a> {
    /// Everything outside the tree of bodies that could act on it.
    pub fn closures(&mut self, sections: &[Element<'a>], cx: &mut Context) {
        let names: BTreeMap<String, usize> = (self.tree.joints.iter().enumerate())
            .filter_map(|(i, joint)| Some((joint.name.given.clone()?, i)))
            .collect();
        let named = Named::new(&self.tree, &names);
        for section in sections {
            match section.name() {
                "equality" => section.check_children(&vocabulary::EQUALITY, cx),
                "tendon" => section.check_children(&vocabulary::TENDONS, cx),
                _ => continue,
            };
        }
        let all = |is_first: bool| {
            // actuators drive tendons, so tendons are read first
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
                "equality" => self.equality(child, &named, cx),
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
}
