//! The base as SDFormat has it.

use mozzi::model::description::{Link, NamedState};
use mozzi::{Base, Description};

/// True if the base is SDFormat's world: a fixed, massless link named `world`.
pub(super) fn has_world(d: &Description) -> bool {
    let base = base_link(d);
    d.base == Base::Fixed && base.is_some_and(|link| link.name == "world" && link.inertia.mass == 0.0)
}

/// The link that is no joint's child.
pub(super) fn base_link(d: &Description) -> Option<&Link> {
    let children: std::collections::BTreeSet<&str> = d.joints.iter().map(|joint| joint.child.as_str()).collect();
    d.links.iter().find(|link| !children.contains(link.name.as_str()))
}

/// The pose of a floating base in the state in which the robot starts, if it is not the identity.
pub(super) fn start_pose(d: &Description) -> Option<(&NamedState, [f64; 7])> {
    let state = d.states.iter().find(|state| Some(&state.name) == d.start.as_ref())?;
    state.base.map(|base| (state, base.pose))
}
