//! The properties of a robot that SDFormat cannot express.

use super::base::{base_link, has_world, start_pose};
use crate::urdf::write::constraint_losses;
use crate::written::{chosen_end_effector, names_of};
use mozzi::model::UNLIMITED;
use mozzi::model::description::{FreeJoint, JointKind};
use mozzi::{Base, Description};

pub(super) fn of(d: &Description) -> Vec<String> {
    let mut losses = Vec::new();
    for joint in &d.joints {
        let name = &joint.name;
        let (limits, is_one) = (joint.limits, matches!(joint.kind, JointKind::Screw(_)));
        let moves = is_one || matches!(joint.kind, JointKind::Ball(_));
        if let Some(limit) = limits.acceleration.filter(|_| moves) {
            losses.push(format!("joint `{name}`: acceleration limit {limit:?}"));
        }
        let is_far = |x: &f64| x.abs() >= UNLIMITED && x.abs() < f64::MAX;
        if let Some(limits) = limits.position.filter(|limits| is_one && limits.iter().any(is_far)) {
            losses.push(format!("joint `{name}`: the limits {limits:?}: from 1e16 on they mean none"));
        }
        if joint.armature != 0.0 && (!is_one || limits.effort == Some(0.0)) {
            let why = if is_one { ", since its effort limit is 0" } else { "" };
            losses.push(format!("joint `{name}`: armature {:?}{why}: M differs", joint.armature));
        }
        if matches!(joint.kind, JointKind::Ball(_)) {
            for (what, is_there) in [
                ("limits", limits.position.is_some() || limits.velocity.is_some() || limits.effort.is_some()),
                ("friction", joint.friction != 0.0),
                ("spring", joint.stiffness != 0.0),
            ] {
                if is_there {
                    losses.push(format!("joint `{name}`: the {what} of a ball"));
                }
            }
        }
        if joint.kind == JointKind::Free && *name != format!("{}:free", joint.child) {
            losses.push(format!("the name of the free joint `{name}`"));
        }
    }
    losses.extend(d.rotors.iter().map(|rotor| format!("rotor `{}`: M differs", rotor.name)));
    losses.extend(constraint_losses(d));
    if d.motors.is_some() {
        losses.push("the list of motors".to_string());
    }
    losses.extend(chosen_end_effector(d));
    if d.base == Base::Floating && d.free_joint != FreeJoint::default() {
        losses.push(format!("the name of the base's free joint, `{}`", d.free_joint.name));
    }
    let kept = start_pose(d).map(|(state, _)| state);
    let is_kept = |name: &str| {
        let kept = kept.filter(|state| state.name == "initial" && name == "initial");
        kept.is_some_and(|state| state.joints.is_empty() && state.base.is_some_and(|base| base.twist == [0.0; 6]))
    };
    let states: Vec<&str> = d.states.iter().map(|state| state.name.as_str()).filter(|name| !is_kept(name)).collect();
    losses.extend(names_of("the named states", &states));
    losses
}

/// Contents of the file that Drake or Gazebo do not take.
pub(super) fn remarks(d: &Description) -> Vec<String> {
    let gravity = (d.gravity != Description::new("").gravity)
        .then(|| format!("Drake ignores the gravity of a file: set {:?} in the program", d.gravity));
    refused_by_gazebo(d).into_iter().chain(gravity).collect()
}

/// Links without mass.
fn refused_by_gazebo(d: &Description) -> Option<String> {
    let base = base_link(d).map(|link| link.name.as_str());
    let has_world = has_world(d);
    let is_massless = |name: &str| !(has_world && Some(name) == base);
    let empty: Vec<&str> = (d.links.iter())
        .filter(|link| link.inertia.mass == 0.0 && is_massless(&link.name))
        .map(|link| link.name.as_str())
        .collect();
    names_of("Gazebo refuses links without mass:", &empty)
}
