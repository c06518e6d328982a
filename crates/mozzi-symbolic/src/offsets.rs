//! Robots with link frames that are not on their joints' axes, such as those of the book's lists and of MJCF. Their
//! lengths are distances between axes, not between link frames.

use crate::letters::printable;
use crate::read::{At, Part};
use crate::symbol::Symbol;
use mozzi::model::description::{Joint, JointKind, Link};
use mozzi::{Description, SE3, SO3, Vec3};
use std::collections::{HashMap, HashSet};

/// Coordinates below this part of the sizes are rounding errors.
const ROUNDING: f64 = 1e-15;

/// The positions of such link frames relative to the nearest points of their joints' axes, in the links' axes, by link.
#[derive(Clone, Debug, Default)]
pub(crate) struct Offsets {
    links: HashMap<String, Vec3>,
    /// The joints whose lengths are not those of the file.
    joints: HashSet<String>,
}

impl Offsets {
    pub fn of(robot: &Description) -> Self {
        let of_joint = |joint: &Joint| Some((joint.child.clone(), offset(joint)?));
        let links: HashMap<String, Vec3> = robot.joints.iter().filter_map(of_joint).collect();
        let is_moved = |joint: &&Joint| links.contains_key(&joint.child) || links.contains_key(&joint.parent);
        let joints = robot.joints.iter().filter(is_moved).map(|joint| joint.name.clone()).collect();
        Offsets { links, joints }
    }

    /// Zero for a link frame on its joint's axis.
    fn link(&self, name: &str) -> Vec3 {
        self.links.get(name).copied().unwrap_or(Vec3::zero())
    }

    /// The position of a joint's axis relative to the axis of its parent link, in the parent link's axes.
    pub fn origin(&self, joint: &Joint) -> Vec3 {
        let (p, offset) = (joint.origin.p, joint.origin.R * self.link(&joint.child));
        if self.joints.contains(&joint.name) { sum([self.link(&joint.parent), p, -offset]) } else { p }
    }

    /// The position of a link's centre of mass relative to the link's axis, in the link's axes.
    pub fn center(&self, link: &Link) -> Vec3 {
        let c = link.inertia.center_of_mass();
        let is_moved = self.links.contains_key(&link.name) && link.inertia.mass != 0.0;
        if is_moved { sum([self.link(&link.name), c, Vec3::zero()]) } else { c }
    }

    /// The offset of a link with its frame at the centre of mass, as in the book's lists: the frame then moves with the
    /// centre.
    pub fn of_center(&self, link: &Link) -> Option<Vec3> {
        let (d, c) = (self.links.get(&link.name)?, link.inertia.center_of_mass());
        (link.inertia.mass != 0.0 && c.norm() < 4.0 * ROUNDING * d.norm()).then_some(*d)
    }

    /// The offsets of all links, exactly, from the exact axes of the joints.
    pub fn exact(&self, robot: &Description<Symbol>) -> HashMap<String, Vec3<Symbol>> {
        let joints = robot.joints.iter().filter(|joint| self.links.contains_key(&joint.child));
        joints.map(|joint| (joint.child.clone(), exact_offset(joint.kind))).collect()
    }

    /// A distance that is not a number of the file, in words.
    pub fn describe(&self, at: At) -> Option<String> {
        let axes = ["x", "y", "z"];
        match at.part {
            Part::Origin(k) if self.joints.contains(at.name) => {
                Some(format!("{} axis {} relative to the axis before it", printable(at.name), axes[k]))
            }
            Part::Center(k) if self.links.contains_key(at.name) => {
                Some(format!("{} centre of mass {} relative to its axis", printable(at.name), axes[k]))
            }
            _ => None,
        }
    }
}

/// −ω × v, or minus the centre of a ball, if it is not 0.
fn offset(joint: &Joint) -> Option<Vec3> {
    let d = match joint.kind {
        JointKind::Screw(A) => -A.twist().w.cross(A.twist().v),
        JointKind::Ball(center) => -center,
        JointKind::Fixed | JointKind::Free => return None,
    };
    let rounded = Vec3(d.0.map(|x| if x.abs() < ROUNDING { 0.0 } else { x }));
    (rounded != Vec3::zero()).then_some(rounded)
}

fn exact_offset(kind: JointKind<Symbol>) -> Vec3<Symbol> {
    match kind {
        JointKind::Screw(A) => -A.twist().w.cross(A.twist().v),
        JointKind::Ball(center) => -center,
        JointKind::Fixed | JointKind::Free => Vec3::zero(),
    }
}

/// The joint with its axis, or the centre of its ball, moved so that its link has this offset.
pub(crate) fn with_offset(kind: JointKind<Symbol>, d: Vec3<Symbol>) -> JointKind<Symbol> {
    match kind {
        JointKind::Screw(A) => JointKind::Screw(A.moved(SE3 { R: SO3::identity(), p: exact_offset(kind) - d })),
        JointKind::Ball(_) => JointKind::Ball(-d),
        other => other,
    }
}

fn sum(parts: [Vec3; 3]) -> Vec3 {
    let size: f64 = parts.iter().map(|p| p.norm()).sum();
    let sum = parts.into_iter().fold(Vec3::zero(), |sum, p| sum + p);
    Vec3(sum.0.map(|x| if f64::abs(x) < 4.0 * ROUNDING * size { 0.0 } else { x }))
}
