//! The links of the file that make up each moving body.

use super::Model;
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;

/// A rigid body of the model: a link that a joint moves, or the base, with all links that are fixed to it.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedBody<'m> {
    /// The joint that moves it; none for the base.
    pub joint: Option<&'m str>,
    /// Names and masses (kg) of the moving link, then of the links folded into it, in the order of the file.
    pub links: Vec<(&'m str, f64)>,
}

impl FoldedBody<'_> {
    /// The total mass, kg.
    pub fn mass(&self) -> f64 {
        self.links.iter().map(|(_, mass)| mass).sum()
    }
}

impl<C: Scalar> Model<C> {
    /// The base, then each moving link base to tips (as [`moving_joints`](Self::moving_joints)), each with the links
    /// that fixed joints fold into it. Every link of the description is in one of them.
    pub fn folded_links(&self) -> Vec<FoldedBody<'_>> {
        let links = &self.description().links;
        let mut bodies = vec![FoldedBody { joint: None, links: Vec::new() }];
        bodies.extend(self.moving_joints().map(|joint| FoldedBody { joint: Some(&joint.name), links: Vec::new() }));
        let (base, moving) = (self.structure.base, &self.structure.moving_links);
        let mut body_of = vec![0; self.links.len() + 1];
        for (body, slot) in (1..).zip(self.moving_slots()) {
            body_of[slot] = body;
            bodies[body].links.push((&links[moving[slot - 1]].name, links[moving[slot - 1]].inertia.mass));
        }
        bodies[0].links.push((&links[base].name, links[base].inertia.mass));
        for (i, link) in links.iter().enumerate() {
            let slot = self.frames[i].slot;
            if i != slot.checked_sub(1).map_or(base, |k| moving[k]) {
                bodies[body_of[slot]].links.push((&link.name, link.inertia.mass));
            }
        }
        bodies
    }
}

#[cfg(test)]
mod tests {
    use crate::model::description::{Joint, JointKind};
    use crate::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};
    use alloc::vec;

    #[test]
    fn fixed_links_are_found_in_the_body_that_carries_them() {
        let mass = |kg| SpatialInertia::point_mass(kg, Vec3([0.1, 0.0, 0.0]));
        let turn = JointKind::Screw(ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit"));
        let joint = |name: &str, parent: &str, child: &str, kind| {
            Joint::new(name, parent, child, SE3::translation([0.0, 0.2, 0.1]), kind)
        };
        let model = Description::new("arm")
            .link("camera", mass(0.25)) // before the link that carries it
            .link("base", mass(8.0))
            .link("upper", mass(4.0))
            .link("lower", mass(2.0))
            .link("stand", mass(16.0))
            .link("lens", mass(0.125))
            .joint(joint("shoulder", "base", "upper", turn))
            .joint(joint("bolt", "upper", "camera", JointKind::Fixed))
            .joint(joint("glue", "camera", "lens", JointKind::Fixed))
            .joint(joint("elbow", "camera", "lower", turn))
            .joint(joint("screw", "base", "stand", JointKind::Fixed))
            .build()
            .expect("a robot");
        let bodies = model.folded_links();
        assert_eq!(bodies[0].links, vec![("base", 8.0), ("stand", 16.0)]);
        assert_eq!(bodies[1].links, vec![("upper", 4.0), ("camera", 0.25), ("lens", 0.125)]);
        assert_eq!(bodies[2].links, vec![("lower", 2.0)]);
        assert_eq!(
            bodies.iter().map(|body| body.joint).collect::<alloc::vec::Vec<_>>(),
            [None, Some("shoulder"), Some("elbow")]
        );
        // the inertias in the kernels have the same mass
        assert_eq!(bodies[0].mass(), model.base_inertia.mass);
        assert!(model.links.iter().zip(&bodies[1..]).all(|(link, body)| link.G.mass == body.mass()));
    }
}
