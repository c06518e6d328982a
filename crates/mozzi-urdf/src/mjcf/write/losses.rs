//! The properties of a robot that MJCF cannot express.

use super::{Plan, equality, is_full, keyframe, travel};
use crate::written::{chosen_end_effector, names_of};
use mozzi::model::description::{FreeJoint, JointKind, Limits, Link};
use mozzi::{Base, Description, SpatialInertia};

pub(super) fn of(d: &Description, plan: &Plan) -> Vec<String> {
    let mut losses = Vec::new();
    let fixed: Vec<&str> = (d.joints.iter())
        .filter(|joint| joint.kind == JointKind::Fixed && joint.name != format!("{}:fixed", joint.child))
        .map(|joint| joint.name.as_str())
        .collect();
    losses.extend(names_of("the names of fixed joints", &fixed));
    let merged: Vec<&str> = (d.joints.iter())
        .filter(|joint| plan.body_of(joint).is_some_and(|body| joint.child != format!("{body}:{}", joint.name)))
        .map(|joint| joint.child.as_str())
        .collect();
    losses.extend(names_of("links without mass between joints", &merged));
    let moving = || d.joints.iter().filter(|joint| joint.kind != JointKind::Fixed);
    let limits_of = |what, is_limited: &dyn Fn(&Limits) -> bool| {
        let limited = moving().filter(|joint| is_limited(&joint.limits)).map(|joint| joint.name.as_str());
        names_of(what, &limited.collect::<Vec<_>>())
    };
    losses.extend(limits_of("the velocity limits of", &|limits| limits.velocity.is_some()));
    losses.extend(limits_of("the acceleration limits of", &|limits| limits.acceleration.is_some()));
    for joint in moving() {
        let (name, limits) = (&joint.name, joint.limits);
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
    losses.extend(chosen_end_effector(d));
    if d.base == Base::Floating && d.free_joint.parent != FreeJoint::default().parent {
        losses.push(format!("the name of the space frame, `{}`", d.free_joint.parent));
    }
    losses.extend(keyframe::loss(d));
    losses
}

/// MuJoCo's mjMINVAL, of a mass and of moments.
const LEAST: f64 = 1e-15;
/// MuJoCo's mjEPS, of the moments of a full inertia.
const LEAST_OF_FULL: f64 = 1e-14;

/// The bodies that MuJoCo's compiler refuses, by reason.
pub(super) fn refused_by_mujoco(d: &Description, plan: &Plan) -> Vec<String> {
    let moments = |link: &Link| link.inertia.verdict().principal_moments;
    let has_inertia = |link: &Link| link.inertia.mass >= LEAST && moments(link)[0] >= LEAST;
    let moving = (d.joints.iter())
        .filter(|joint| joint.kind != JointKind::Fixed && plan.next(joint).is_none())
        .map(|joint| joint.child.as_str())
        .chain(plan.base.filter(|_| d.base == Base::Floating).map(|base| base.name.as_str()));
    // one of the bodies fixed to each other is enough
    let is_weightless = |link: &&str| !plan.fixed_to(link).into_iter().any(has_inertia);
    let empty: Vec<&str> = moving.filter(is_weightless).collect();
    let of = |is_refused: &dyn Fn(&Link) -> bool| -> Vec<&str> {
        let written = d.links.iter().filter(|link| link.inertia != SpatialInertia::zero());
        written.filter(|link| is_refused(link)).map(|link| link.name.as_str()).collect()
    };
    let is_full = |link: &Link| is_full(link.inertia.about_center_of_mass());
    let flat = of(&|link| is_full(link) && moments(link)[0] < LEAST_OF_FULL);
    let unbalanced = of(&|link| {
        let [a, b, c] = moments(link);
        a + b < c && (!is_full(link) || a >= LEAST_OF_FULL)
    });
    let reasons = [
        ("moving bodies whose mass or a moment is below 1e-15:", empty),
        ("inertias with products and a principal moment below 1e-14:", flat),
        ("inertias with a moment above the sum of the others (`balanceinertia` changes them):", unbalanced),
    ];
    reasons.into_iter().filter_map(|(what, names)| names_of(&format!("MuJoCo refuses {what}"), &names)).collect()
}
