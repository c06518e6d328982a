//! Bodies have a physical inertia and can be accelerated.
//!
//! A joint moves not one link but the rigid body of all links fixed to each other, so inertias are judged body by body.
//! A link whose inertia violates the triangle inequality is used as given, with a warning: the kinetic energy is still
//! positive. A link with a negative principal moment is an error if its body has one too: some motion then has a
//! negative kinetic energy, and forward dynamics is meaningless. If the body is sound, the link gets a warning. Five
//! links of the published robots in `example-robot-data` have a negative moment beyond rounding: two antennas of TIAGo,
//! −4·10⁻⁸ kg m² on a base of 28 kg (loaded, with a warning), and trunk and hips of one Romeo, −2·10⁻² and −3·10⁻³ kg
//! m² (refused).

use super::tree::Tree;
use super::{Element, Report, Severity, numbers::is_finite};
use crate::lie::SE3;
use crate::model::description::JointKind;
use crate::spatial::{InertiaVerdict, SpatialInertia};
use alloc::collections::BTreeSet;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;

/// A rigid body: links fixed to each other.
struct Body {
    /// In the frame of its first link.
    inertia: SpatialInertia,
    links: usize,
    /// True if a joint moves the body and the body carries no further joint.
    is_leaf: bool,
}

impl Report<'_> {
    /// Links and bodies whose inertia is unphysical, or that cannot be accelerated.
    pub(super) fn inertias(&mut self, tree: Option<&Tree>) {
        let d = self.description;
        let is_sound = |inertia: &SpatialInertia| is_finite(inertia) && inertia.mass >= 0.0;
        // without a tree, each link is checked separately
        let (body_of, bodies) = match tree {
            Some(tree) if d.links.iter().all(|link| is_sound(&link.inertia)) => self.bodies(tree),
            _ => {
                let alone = |inertia| Body { inertia, links: 1, is_leaf: false };
                ((0..d.links.len()).collect(), d.links.iter().map(|link| alone(link.inertia)).collect())
            }
        };
        for (i, link) in d.links.iter().enumerate().filter(|(_, link)| is_sound(&link.inertia)) {
            let (verdict, element, body) = (link.inertia.verdict(), Element::Link(i), &bodies[body_of[i]]);
            if verdict.is_physical() {
                continue;
            }
            if !is_indefinite(&verdict) {
                self.add(Severity::Warning, element, "inertia", "unphysical_inertia", format!("{verdict}"));
            } else if is_indefinite(&body.inertia.verdict()) {
                let with = match body.links {
                    1 => "",
                    _ => "; the body that it is part of has a negative moment, too",
                };
                self.error(element, "inertia", "indefinite_inertia", format!("{verdict}{with}"));
            } else {
                let message = format!("{verdict}; the body that it is part of is positive definite");
                self.add(Severity::Warning, element, "inertia", "unphysical_inertia", message);
            }
        }
        if let Some(tree) = tree {
            self.massless_leaves(tree, &body_of, &bodies);
        }
    }

    /// The body of each link, and the bodies.
    fn bodies(&self, tree: &Tree) -> (Vec<usize>, Vec<Body>) {
        let d = self.description;
        let (mut body_of, mut bodies) = (vec![0; d.links.len()], Vec::<Body>::new());
        let mut frames = vec![SE3::identity(); d.links.len()];
        for &i in &tree.order {
            let inertia = d.links[i].inertia;
            let joint = tree.joint[i].map(|joint| &d.joints[joint]);
            let parent = tree.parent[i];
            match joint {
                Some(joint) if joint.kind == JointKind::Fixed => {
                    body_of[i] = body_of[parent];
                    frames[i] = frames[parent] * joint.origin;
                    let body = &mut bodies[body_of[i]];
                    body.inertia += inertia.congruence(frames[i].inverse().Ad());
                    body.links += 1;
                }
                moving => {
                    if moving.is_some() {
                        bodies[body_of[parent]].is_leaf = false;
                    }
                    body_of[i] = bodies.len();
                    bodies.push(Body { inertia, links: 1, is_leaf: moving.is_some() });
                }
            }
        }
        (body_of, bodies)
    }

    /// The last body of a branch, without inertia about the joint that moves it: its acceleration is undefined.
    fn massless_leaves(&mut self, tree: &Tree, body_of: &[usize], bodies: &[Body]) {
        let d = self.description;
        let followed: BTreeSet<&str> =
            d.joints.iter().filter_map(|joint| joint.mimic.as_ref()).map(|mimic| mimic.joint.as_str()).collect();
        for &i in &tree.order {
            let Some(joint) = tree.joint[i].map(|joint| &d.joints[joint]) else { continue };
            let (JointKind::Screw(A), body) = (joint.kind, &bodies[body_of[i]]) else { continue };
            let has_mimic_joints = joint.mimic.is_some() || followed.contains(joint.name.as_str());
            if !body.is_leaf || has_mimic_joints || joint.armature != 0.0 {
                continue;
            }
            // the inertia about the axis, compared with that of any motion
            let (G, V) = (body.inertia, A.twist());
            if V.dot(G * V) <= 1e-14 * (G.I.trace().abs() + G.mass) {
                let message =
                    format!("joint `{}` moves it, but it has no inertia: forward dynamics is undefined", joint.name);
                self.add(Severity::Warning, Element::Link(i), "mass", "massless_leaf", message);
            }
        }
    }
}

/// True if a principal moment is negative beyond rounding error.
fn is_indefinite(verdict: &InertiaVerdict) -> bool {
    let [a, b, c] = verdict.principal_moments;
    !verdict.is_physical() && a < -1e-9 * (a.abs() + b.abs() + c.abs())
}
