//! `<freejoint>`, and joints of type `free`: free bodies. A free body that carries all moving bodies is the robot's
//! floating base.

use super::Model;
use super::attributes::Item;
use super::contents::{Contents, Inside};
use super::tree::{Free, Joint, Name};
use super::vocabulary;
use crate::report::places::Place;
use crate::text::context::Context;
use mozzi::SE3;
use mozzi::model::description::{ConstraintKind, JointKind};

impl<'a> Model<'a> {
    /// Whether the next link's body is free. Adds its joint with this initial pose; reports an invalid free joint.
    pub fn free(&mut self, contents: &Contents<'a>, carrier: usize, body: &str, start: SE3, cx: &mut Context) -> bool {
        let Some(Inside { item, around, .. }) = contents.free.first() else { return false };
        self.tree.degrees += contents.free.len();
        let is_word = item.element.name() == "freejoint";
        let name = Name::of(&item.element.called("joint"), format!("{body}:free"), cx).suffixed(&around.suffix);
        let subject =
            name.given.as_ref().map_or_else(|| item.element.subject.clone(), |_| format!("joint `{}`", name.shown()));
        let item = Item { element: item.element.called(subject), ..item.clone() };
        item.element.check_attributes(if is_word { &vocabulary::FREE_JOINT } else { &vocabulary::JOINT }, cx);
        let why = if carrier != 0 {
            Some("is a free joint inside the tree: in MJCF only a body of the world can be free")
        } else if contents.joints.len() + contents.free.len() > 1 {
            Some("is a free joint in a body with other joints, expected no others")
        } else {
            None
        };
        if let Some(why) = why {
            let help =
                "MuJoCo refuses it, too; inside the tree, a ball and three slides in one body move like a free joint";
            cx.findings.add(item.error("unsupported_joint", "", why).help(help));
            return false;
        }
        let [damping, armature] = self.forces(&item, cx);
        let word = if is_word { item.word("align", &["auto", "true", "false"], cx) } else { None };
        let aligned = match word {
            Some("true") => true,
            Some("false") => false,
            _ => self.compiler.of(&item.element).align_free,
        };
        if aligned && contents.bodies.is_empty() {
            let message = "would be aligned with the body's inertia, which moves the body's frame";
            let help = "set align=\"false\" of a <freejoint>: positions are then those of the file's frame";
            cx.findings.add(item.error("unsupported_attribute", "align", message).help(help));
        }
        let mut place = Place::new(item.element.span());
        for name in ["damping", "armature"] {
            if let Some(value) = item.value(name) {
                place.set(name, value.span);
            }
        }
        let link = self.tree.links.len();
        // its positions are the pose in the world, wherever the body is at first
        let added = self.tree.joint(name, [carrier, link], SE3::identity(), place);
        (added.joint.kind, added.joint.damping, added.joint.armature) = (JointKind::Free, damping, armature);
        added.start = start;
        true
    }

    /// The damping and the armature of a free joint. A warning lists forces that are not computed.
    fn forces(&mut self, item: &Item<'a>, cx: &mut Context) -> [f64; 2] {
        if item.element.name() == "freejoint" {
            return [0.0; 2];
        }
        let [linear, quadratic, cubic] = item.overlaid::<3>("damping", cx);
        if self.options.damper && (quadratic != 0.0 || cubic != 0.0) {
            self.ignored.force("damping", item, "damping", "nonlinear damping");
        }
        if self.options.friction && item.number("frictionloss", 0.0, cx) != 0.0 {
            self.ignored.force("free frictionloss", item, "frictionloss", "friction of a free body");
        }
        if self.options.spring && item.overlaid::<3>("stiffness", cx) != [0.0; 3] {
            self.ignored.force("free stiffness", item, "stiffness", "a spring of a free body");
        }
        [if self.options.damper { linear } else { 0.0 }, item.number("armature", 0.0, cx)]
    }

    /// If one free body carries all moving bodies, and its joint has neither damping nor armature, it is a floating
    /// base. Otherwise the world is the base.
    pub fn leave_the_world(&mut self) {
        let mut free = self.tree.joints.iter().filter(|joint| joint.joint.kind == JointKind::Free);
        let (Some(base), None) = (free.next(), free.next()) else { return };
        let link = base.child;
        let mut stays = vec![false; self.tree.links.len()];
        stays[link] = true;
        // parents precede their children
        for joint in self.tree.joints.iter().filter(|joint| joint.child != link) {
            stays[joint.child] = stays[joint.parent];
        }
        let beside = |joint: &Joint| !stays[joint.child] && joint.joint.kind != JointKind::Fixed;
        if base.joint.damping != 0.0 || base.joint.armature != 0.0 || self.tree.joints.iter().any(beside) {
            return;
        }
        let (joint, start) = (base.name.given.clone(), base.start);
        let poses = self.tree.poses();
        self.tree.joints.retain(|joint| joint.child != link);
        let mut free = Free { link, joint, start };
        let base = self.tree.links[free.link].name.shown();
        for (link, _) in self.tree.links.iter().zip(&stays).skip(1).filter(|(_, stays)| !**stays) {
            self.ignored.beside("body", &link.name.shown(), link.place.span(""), &base);
        }
        for site in self.tree.sites.iter().filter(|site| !stays[site.link]) {
            self.ignored.beside("site", &crate::urdf::vocabulary::shown(&site.name), site.place.span(""), &base);
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
        if let Some(shapes) = &mut self.shapes {
            shapes.renumber(&stays, &numbers);
        }
        for joint in &mut self.tree.joints {
            (joint.parent, joint.child) = (numbers[joint.parent], numbers[joint.child]);
        }
        self.tree.sites.iter_mut().for_each(|site| site.link = numbers[site.link]);
        for one in &mut self.tree.constraints {
            // anchors outside the free body's tree are in {s}
            if let ConstraintKind::Frames { a, b, .. } = &mut one.kind {
                for (link, anchor) in one.links.iter_mut().zip([a, b]) {
                    if let Some(still) = link.filter(|&i| !stays[i]) {
                        (*link, anchor.T) = (None, poses[still] * anchor.T);
                    }
                }
            }
            one.links = one.links.map(|link| link.map(|i| numbers[i]));
        }
        self.tree.free = Some(free);
    }
}
