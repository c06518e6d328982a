//! The compiler's settotalmass, and the bodies that do not count: fusestatic merges them into the world first.

use super::Model;
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::SpatialInertia;
use mozzi::model::description::JointKind;
use std::collections::BTreeSet;

/// Attributes whose value is the name of a body.
const BODIES: [&str; 6] = ["body", "body1", "body2", "subtree1", "subtree2", "target"];
/// Attributes whose value is the name of a body if the other attribute names a type of bodies.
const OBJECTS: [(&str, &str); 2] = [("objname", "objtype"), ("refname", "reftype")];

impl Model<'_> {
    /// Scales all bodies to the compiler's settotalmass.
    pub fn scale_to_total_mass(&mut self, root: &Element, cx: &mut Context) {
        let Some(total) = self.compiler.main.total_mass else { return };
        let is_fused = if self.compiler.main.fuses { self.fused(root) } else { vec![false; self.tree.links.len()] };
        let counted = self.tree.links.iter().zip(&is_fused).filter(|(_, is_fused)| !**is_fused);
        let mass: f64 = counted.map(|(link, _)| link.inertia.mass).sum();
        if is_fused.iter().all(|&is_fused| is_fused) && self.tree.links.len() > 1 {
            return; // as in MuJoCo: nothing is left to scale
        }
        if !(mass > 0.0) {
            let message = format!("compiler: settotalmass: the bodies' total mass {mass} cannot be scaled to {total}");
            cx.findings.add(Finding::error("no_mass", self.tree.links[0].place.span(""), message));
            return;
        }
        let k = total / mass;
        for SpatialInertia { mass, mc, I } in self.tree.links.iter_mut().map(|link| &mut link.inertia) {
            (*mass, *mc, *I) = (*mass * k, *mc * k, *I * k);
        }
    }

    /// Whether MuJoCo merges each link into the world. A body to which another element refers stays, as does one with
    /// the site of a force or torque sensor; what is merged into such a body counts.
    fn fused(&self, root: &Element) -> Vec<bool> {
        let (mut bodies, mut sites) = (BTreeSet::new(), BTreeSet::new());
        let mut open = vec![root.clone()];
        while let Some(element) = open.pop() {
            let value = |name: &str| element.attribute(name).map(|value| value.text);
            bodies.extend(BODIES.iter().filter_map(|name| value(name)));
            let is_body = |kind: &str| value(kind).is_some_and(|kind| ["body", "xbody"].contains(&kind));
            bodies.extend(OBJECTS.iter().filter(|(_, kind)| is_body(kind)).filter_map(|(name, _)| value(name)));
            if ["force", "torque"].contains(&element.name()) {
                sites.extend(value("site"));
            }
            open.extend(element.elements());
        }
        let mut stays: Vec<bool> = (self.tree.links.iter())
            .map(|link| link.is_mocap || link.name.given.as_deref().is_some_and(|name| bodies.contains(name)))
            .collect();
        for site in self.tree.sites.iter().filter(|site| sites.contains(site.name.as_str())) {
            stays[site.link] = true;
        }
        let mut is_fused = vec![false; self.tree.links.len()];
        is_fused[0] = true;
        // parents precede their children
        for joint in self.tree.joints.iter().filter(|joint| joint.joint.kind == JointKind::Fixed) {
            is_fused[joint.child] = is_fused[joint.parent] && !stays[joint.child];
        }
        is_fused
    }
}

#[cfg(test)]
mod tests {
    fn masses(compiler: &str, bodies: &str, rest: &str) -> Vec<f64> {
        let text = format!("<mujoco><compiler {compiler}/><worldbody>{bodies}</worldbody>{rest}</mujoco>");
        let robot = crate::parse("a.xml", &text).unwrap_or_else(|error| panic!("{error}")).description;
        let of = |name: &str| robot.links.iter().find(|link| link.name == name).map(|link| link.inertia.mass);
        ["s", "t", "a"].into_iter().filter_map(of).collect()
    }

    #[test]
    fn what_is_fused_into_the_world_does_not_count() {
        let s = "<body name='s'><geom name='g' size='.1'/><site name='p'/></body>";
        let a = "<body name='a'><joint name='j'/><geom size='.1' pos='.1 0 0'/></body>";
        let fused = "settotalmass='7' fusestatic='true'";
        let of = |bodies: &str, rest: &str| {
            masses(fused, bodies, rest).last().copied().map(|mass| (mass * 1e4).round() / 1e4)
        };
        let both = format!("{s}{a}");
        assert_eq!(masses("settotalmass='7'", &both, ""), [3.5, 3.5]);
        let sensors = |text: &str| format!("<sensor>{text}</sensor>");
        // MuJoCo 4.0's mass of body a
        for (rest, expected) in [
            (String::new(), 7.0),
            (sensors("<framepos objtype='site' objname='p'/>"), 7.0),
            (sensors("<framepos objtype='geom' objname='g'/>"), 7.0),
            (sensors("<gyro site='p'/>"), 7.0),
            (sensors("<force site='p'/>"), 3.5),
            (sensors("<framepos objtype='body' objname='s'/>"), 3.5),
            (sensors("<framepos objtype='body' objname='a' reftype='xbody' refname='s'/>"), 3.5),
            ("<contact><exclude body1='s' body2='a'/></contact>".to_string(), 3.5),
        ] {
            assert_eq!(of(&both, &rest), Some(expected), "{rest}");
        }
        assert_eq!(of(&both.replace("name='s'", "name='s' mocap='true'"), ""), Some(3.5));
        assert_eq!(of(&format!("<body name='s'><geom size='.1'/>{a}</body>"), ""), Some(7.0));
        let nested = format!("<body name='s'><geom size='.1'/><body name='t'><geom size='.1'/></body></body>{a}");
        for (body, expected) in [("s", 2.3333), ("t", 3.5), ("a", 7.0)] {
            let rest = sensors(&format!("<framepos objtype='body' objname='{body}'/>"));
            assert_eq!(of(&nested, &rest), Some(expected), "{body}");
        }
        assert!(masses(fused, s, "").iter().all(|mass| (mass - 4.18879).abs() < 1e-5), "{:?}", masses(fused, s, ""));
    }
}
