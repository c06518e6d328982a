//! The properties of a robot that MJCF cannot express.

use super::{Plan, equality, keyframe, travel};
use crate::written::names_of;
use mozzi::Base;
use mozzi::Description;
use mozzi::model::description::{FreeJoint, JointKind};

pub(super) fn of(d: &Description, plan: &Plan) -> Vec<String> {
    let mut losses = Vec::new();
    let fixed: Vec<&str> = (d.joints.iter())
        .filter(|joint| joint.kind == JointKind::Fixed && joint.name != format!("{}:fixed", joint.child))
        .map(|joint| joint.name.as_str())
        .collect();
    losses.extend(names_of("the names of fixed joints", &fixed));
    let merged: Vec<&str> = (d.joints.iter())
        .filter(|joint| plan.next(joint).is_some_and(|next| joint.child != format!("{}:{}", next.child, joint.name)))
        .map(|joint| joint.child.as_str())
        .collect();
    losses.extend(names_of("links without mass between joints", &merged));
    for joint in d.joints.iter().filter(|joint| joint.kind != JointKind::Fixed) {
        let (name, limits) = (&joint.name, joint.limits);
        for (what, limit) in [("velocity", limits.velocity), ("acceleration", limits.acceleration)] {
            if let Some(limit) = limit {
                losses.push(format!("joint `{name}`: {what} limit {limit:?}"));
            }
        }
        if limits.effort == Some(0.0) {
            losses.push(format!("joint `{name}`: effort limit 0, which MuJoCo has not"));
        }
        if let Some([low, high]) = limits.position.filter(|[low, high]| low == high) {
            losses.push(format!("joint `{name}`: the limits {low:?} to {high:?}, an empty range"));
        }
        if travel(joint.kind).is_some() {
            losses
                .push(format!("joint `{name}`: a screw, written as a hinge and the slide `{name}.travel`, tied to it"));
        }
        let several = matches!(joint.kind, JointKind::Free) && (joint.friction != 0.0 || joint.stiffness != 0.0);
        if several {
            losses.push(format!("joint `{name}`: friction or spring of a free joint"));
        }
    }
    losses.extend(d.constraints.iter().filter_map(equality::loss));
    if d.motors.is_some() {
        losses.push("the list of motors".to_string());
    }
    losses.extend(d.end_effector.iter().map(|name| format!("the choice of the end effector, `{name}`")));
    if d.base == Base::Floating && d.free_joint.parent != FreeJoint::default().parent {
        losses.push(format!("the name of the space frame, `{}`", d.free_joint.parent));
    }
    losses.extend(keyframe::loss(d));
    losses
}

/// Links without mass that move, and are not merged.
pub(super) fn refused_by_mujoco(d: &Description, plan: &Plan) -> Option<String> {
    let empty: Vec<&str> = (d.joints.iter())
        .filter(|joint| joint.kind != JointKind::Fixed && plan.next(joint).is_none())
        .filter(|joint| d.links.iter().any(|link| link.name == joint.child && link.inertia.mass == 0.0))
        .map(|joint| joint.child.as_str())
        .collect();
    names_of("MuJoCo refuses links without mass that move:", &empty)
}
