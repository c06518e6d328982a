//! `<freejoint>`, and joints of type `free`: the base, which hangs on nothing.

use super::Model;
use super::attributes::Item;
use super::contents::{Contents, Inside};
use super::tree::{Free, Joint, Name};
use super::vocabulary;
use crate::context::Context;
use crate::finding::Finding;
use mozzi::model::description::JointKind;

impl<'a> Model<'a> {
    /// Is the body, whose link comes next, free? A free joint that cannot be is refused.
    pub fn free(&mut self, contents: &Contents<'a>, carrier: usize, cx: &mut Context) -> bool {
        let Some(Inside { item, .. }) = contents.free.first() else { return false };
        self.tree.degrees += contents.free.len();
        let is_word = item.element.name() == "freejoint";
        let name = Name::of(&item.element.called("joint"), "of a free body".to_string(), cx);
        let subject =
            name.given.as_ref().map_or_else(|| item.element.subject.clone(), |_| format!("joint `{}`", name.shown()));
        let item = Item { element: item.element.called(subject), ..item.clone() };
        item.element.check_attributes(if is_word { &vocabulary::FREE_JOINT } else { &vocabulary::JOINT }, cx);
        let why = if carrier != 0 {
            Some("is a free joint inside the tree: only a body of the world can be free".to_string())
        } else if contents.joints.len() + contents.free.len() > 1 {
            Some("is a free joint beside other joints of its body, expected it alone".to_string())
        } else if let Some(first) = &self.tree.free {
            let first = self.tree.links[first.link].name.shown();
            Some(format!("is a second free joint: body `{first}` is free already, expected one robot"))
        } else {
            None
        };
        if let Some(why) = why {
            let help = "the base of a robot can be free; inside the tree, three slides and three hinges in one body move as a free \
                        joint does, away from the position where two hinges line up";
            cx.findings.add(item.error("unsupported_joint", "", &why).help(help));
            return false;
        }
        self.forces(&item, cx);
        let aligned = match item.word("align", &["auto", "true", "false"], cx).filter(|_| is_word) {
            Some("true") => true,
            Some("false") => false,
            _ => self.compiler.align_free && is_word,
        };
        if aligned && contents.bodies.is_empty() {
            let message = "is aligned with the body's inertia, which moves the body's frame";
            let help = "set align=\"false\": positions are then those of the frame that the file says";
            cx.findings.add(item.error("unsupported_attribute", "align", message).help(help));
        }
        self.tree.free = Some(Free { link: self.tree.links.len(), joint: name.given });
        true
    }

    /// What would act between the world and the base: forces are told, an inertia is not left out.
    fn forces(&mut self, item: &Item<'a>, cx: &mut Context) {
        if item.element.name() == "freejoint" {
            return;
        }
        if item.number("armature", 0.0, cx) != 0.0 {
            let message = "armature: would add an inertia between the world and the base, which mozzi does not";
            let help = "set armature=\"0\" on the free joint";
            cx.findings.add(item.error("unsupported_attribute", "armature", message).help(help));
        }
        let (damper, spring) = (self.options.damper, self.options.spring);
        if damper && item.overlaid::<3>("damping", cx) != [0.0; 3] {
            self.ignored.force("free damping", item, "damping", "a damping of the floating base");
        }
        if self.options.friction && item.number("frictionloss", 0.0, cx) != 0.0 {
            self.ignored.force("free frictionloss", item, "frictionloss", "a friction of the floating base");
        }
        if spring && item.overlaid::<3>("stiffness", cx) != [0.0; 3] {
            self.ignored.force("free stiffness", item, "stiffness", "a spring of the floating base");
        }
    }

    /// Where a body is free, it alone with all that it carries is the robot. What else moves in the world would be lost.
    pub fn leave_the_world(&mut self, cx: &mut Context) {
        let Some(free) = &mut self.tree.free else { return };
        let base = self.tree.links[free.link].name.shown();
        let mut stays = vec![false; self.tree.links.len()];
        stays[free.link] = true;
        // parents stand before their children
        for joint in &self.tree.joints {
            stays[joint.child] = stays[joint.parent];
        }
        for Joint { name, joint, place, .. } in self.tree.joints.iter().filter(|joint| !stays[joint.child]) {
            if joint.kind != JointKind::Fixed {
                let message =
                    format!("joint `{}`: moves beside the free body `{base}`, expected one robot", name.shown());
                let help = "remove the one or the other: mozzi computes one tree, on the ground or free";
                cx.findings.add(Finding::error("unsupported_joint", place.span(""), message).help(help));
            }
        }
        for (link, _) in self.tree.links.iter().zip(&stays).skip(1).filter(|(_, stays)| !**stays) {
            self.ignored.beside("body", &link.name.shown(), link.place.span(""), &base);
        }
        for site in self.tree.sites.iter().filter(|site| !stays[site.link]) {
            self.ignored.beside("site", &crate::vocabulary::shown(&site.name), site.place.span(""), &base);
        }
        let mut count = 0;
        let number = |stays: &bool| {
            count += usize::from(*stays);
            count.wrapping_sub(1)
        };
        let numbers: Vec<usize> = stays.iter().map(number).collect();
        free.link = numbers[free.link];
        let mut each = stays.iter();
        self.tree.links.retain(|_| each.next() == Some(&true));
        self.tree.joints.retain(|joint| stays[joint.child]);
        self.tree.sites.retain(|site| stays[site.link]);
        for joint in &mut self.tree.joints {
            (joint.parent, joint.child) = (numbers[joint.parent], numbers[joint.child]);
        }
        self.tree.sites.iter_mut().for_each(|site| site.link = numbers[site.link]);
    }
}
