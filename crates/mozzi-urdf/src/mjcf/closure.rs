//! Elements outside the tree of bodies that act on it: tendons, then equalities and flexible bodies, then actuators.

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
        // equalities tie tendons, and actuators drive them
        let order = |section: &&Element| match section.name() {
            "tendon" => 0,
            "actuator" => 2,
            _ => 1,
        };
        let mut ordered: Vec<&Element> = sections.iter().collect();
        ordered.sort_by_key(order);
        for (section, child) in ordered.into_iter().flat_map(|s| s.elements().map(move |child| (s, child))) {
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
