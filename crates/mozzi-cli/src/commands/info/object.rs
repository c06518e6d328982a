//! `mozzi info --json`.

use super::{kind, rank, total_mass};
use crate::commands::assemble;
use crate::json;
use mozzi::model::State;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Model, SE3};
use serde_json::{Value, json};

pub fn object(model: &Model, poses: &[SE3]) -> Value {
    let robot = model.description();
    let joint = |joint: &Joint| {
        json!({
            "name": joint.name,
            "type": kind(joint),
            "parent": joint.parent,
            "child": joint.child,
            "screw_axis": match joint.kind {
                JointKind::Screw(A) => Some(json::vector(&A.twist().to_array())),
                JointKind::Fixed | JointKind::Ball(_) | JointKind::Free => None,
            },
            "center": match joint.kind {
                JointKind::Ball(center) => Some(json::vector(&center.0)),
                _ => None,
            },
            "origin": json::pose(joint.origin),
            "limits": {
                "position": joint.limits.position.map(|limits| json::vector(&limits)),
                "velocity": joint.limits.velocity,
                "effort": joint.limits.effort,
            },
            "damping": joint.damping,
            "friction": joint.friction,
            "armature": joint.armature,
            "stiffness": joint.stiffness,
            "spring_reference": joint.spring_reference,
            "mimic": joint.mimic.as_ref().map(|mimic| json!({
                "joint": mimic.joint, "ratio": mimic.ratio, "offset": mimic.offset,
            })),
        })
    };
    let state = |name| {
        let State { time, theta, dtheta } = model.state(name).ok()?;
        Some(json!({ "name": name, "time": time, "theta": json::vector(&theta), "dtheta": json::vector(&dtheta) }))
    };
    json!({
        "robot": robot.name,
        "n": model.n(),
        "nq": model.nq(),
        "base": json::base(model),
        "positions": json::names(model.position_names()),
        "velocities": json::names(model.velocity_names()),
        "moving_links": model.moving_links(),
        "total_mass": total_mass(robot),
        "gravity": json::vector(&model.gravity().0),
        "rotors": robot.rotors.iter().map(|rotor| json!({
            "name": rotor.name, "armature": rotor.armature,
            "gears": rotor.gears.iter().map(|gear| json!({ "joint": gear.joint, "ratio": gear.ratio })).collect::<Value>(),
        })).collect::<Value>(),
        "constraints": model.constraints().iter().map(|constraint| json!({
            "name": constraint.name, "kind": constraint.kind_name(), "rows": constraint.row_names(),
        })).collect::<Value>(),
        "constraint_rank": (model.constraint_rows() > 0).then(|| rank(model).ok().map(|rank| assemble::object(&rank))).flatten(),
        "end_effector": model.end_effector().ok().map(|frame| model.frame_name(frame)),
        "states": model.state_names().filter_map(state).collect::<Value>(),
        "start": robot.start,
        "independent_joints": model.joint_names().collect::<Vec<_>>(),
        "joints": robot.joints.iter().map(joint).collect::<Value>(),
        "links": robot.links.iter().map(|link| json!({
            "name": link.name,
            "mass": link.inertia.mass,
            "center_of_mass": json::vector(&link.inertia.center_of_mass().0),
            "rotational_inertia": json::rows(link.inertia.about_center_of_mass().to_mat3().rows()),
        })).collect::<Value>(),
        "bodies": model.folded_links().iter().map(|body| json!({
            "joint": body.joint,
            "mass": body.mass(),
            "links": body.links.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
        })).collect::<Value>(),
        "frames": model.frames().zip(poses).map(|((_, name), &T)| json!({
            "name": name, "home": json::pose(T),
        })).collect::<Value>(),
    })
}
