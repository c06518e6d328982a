//! A floating joint at the root is a floating base: the link that carries it is {s}, and no link of the robot.

use crate::context::Context;
use crate::finding::Finding;
use crate::places::Places;
use crate::vocabulary::shown;
use mozzi::model::description::FreeJoint;
use mozzi::{Base, Description, SE3, SpatialInertia};

/// Frees the base where one of these joints, the floating ones, says so; refuses every other.
pub(crate) fn free_base(floating: &[usize], description: &mut Description, places: &mut Places, cx: &mut Context) {
    if places.tree_is_partial() {
        return; // what carries what is not known, as was said
    }
    let mut free = None;
    for &i in floating {
        match obstacle(i, description) {
            None => free = Some(i),
            Some(Obstacle { why, help }) => {
                let joint = &description.joints[i];
                let message = format!("joint `{}`: type: is `floating`, but {why}", shown(&joint.name));
                cx.findings.add(Finding::error("unsupported_joint", places.joints[i].span("kind"), message).help(help));
            }
        }
    }
    let Some(i) = free else { return };
    let Some(world) = description.links.iter().position(|link| link.name == description.joints[i].parent) else {
        return;
    };
    let joint = description.joints.remove(i);
    places.joints.remove(i);
    description.links.remove(world);
    places.links.remove(world);
    description.base = Base::Floating;
    description.free_joint = FreeJoint { name: joint.name, parent: joint.parent };
}

/// Why a floating joint does not free the base.
struct Obstacle {
    why: String,
    help: &'static str,
}

const INSIDE: &str = "the base of a robot can be free; inside the tree, build the joint from three slides and three hinges, which are \
                      valid away from the position where two hinges line up";
const ROOT: &str = "the link from which the base is freed is the space frame: no mass, no other joint, and the base's frame on it at 0";

fn obstacle(i: usize, description: &Description) -> Option<Obstacle> {
    let joint = &description.joints[i];
    let others = || description.joints.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, other)| other);
    let root = description.links.iter().find(|link| link.name == joint.parent)?;
    let name = shown(&joint.parent);
    let (why, help) = if let Some(other) = others().find(|other| other.child == joint.parent) {
        (format!("its parent `{name}` is not the root of the tree: joint `{}` leads to it", shown(&other.name)), INSIDE)
    } else if let Some(other) = others().find(|other| other.parent == joint.parent) {
        (format!("its parent `{name}` carries joint `{}` too", shown(&other.name)), ROOT)
    } else if root.inertia != SpatialInertia::zero() {
        (format!("its parent `{name}` has a mass of {} kg, or moments", root.inertia.mass), ROOT)
    } else if joint.origin != SE3::identity() {
        (format!("its origin is {:?} m, turned by {:?} rad", joint.origin.p.0, joint.origin.R.to_rpy()), ROOT)
    } else {
        return None;
    };
    Some(Obstacle { why, help })
}
