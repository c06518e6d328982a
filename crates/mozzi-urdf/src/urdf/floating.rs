//! A floating joint at the root is a floating base: its parent link is {s}, not a link of the robot. Any other floating
//! joint is a free joint.

use crate::report::places::Places;
use mozzi::model::description::FreeJoint;
use mozzi::{Base, Description, SE3, SpatialInertia};

/// Makes the base floating if one of these floating joints is alone between an empty root link and the base, with their
/// frames coincident at 0. The other floating joints are free joints in the tree.
pub(crate) fn free_base(floating: &[usize], description: &mut Description, places: &mut Places) {
    if places.tree_is_partial() {
        return; // the tree is incomplete, as already reported
    }
    let Some(&i) = floating.iter().find(|&&i| frees_the_base(i, description)) else { return };
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

pub(crate) fn frees_the_base(i: usize, description: &Description) -> bool {
    let joint = &description.joints[i];
    let mut others = description.joints.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, other)| other);
    let is_alone = !others.any(|other| other.child == joint.parent || other.parent == joint.parent);
    let root = description.links.iter().find(|link| link.name == joint.parent);
    let is_empty = root.is_some_and(|root| root.inertia == SpatialInertia::zero());
    is_alone && is_empty && joint.origin == SE3::identity()
}
