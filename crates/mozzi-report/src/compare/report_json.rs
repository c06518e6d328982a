//! The comparison's report as JSON.

use crate::compare::answer::Unavailable;
use crate::compare::bodies::BodyChange;
use crate::compare::cause::{Cause, Change};
use crate::compare::numbers::Errors;
use crate::compare::report_text::Finding;
use crate::compare::verdict::Verdict;
use crate::compare::vocabulary;
use serde_json::{Value, json};

pub fn object(finding: &Finding) -> Value {
    let answer = &finding.answer;
    let mut object = json!({
        "library": answer.library,
        "version": answer.version,
        "status": status(finding),
        "message": match &answer.robot {
            Err(unavailable) => Value::from(vocabulary::unavailable(unavailable, answer.library)),
            Ok(_) => Value::Null,
        },
        "fault": match &answer.robot {
            Err(Unavailable::Died(_, fault)) => Value::from(fault.name()),
            _ => Value::Null,
        },
        "refusals": answer.attempts.iter().map(|(message, workaround)| json!({
            "message": message, "then": vocabulary::workaround(*workaround),
        })).collect::<Value>(),
    });
    if let (Ok(robot), Some(verdict)) = (&answer.robot, &finding.verdict) {
        object["joints"] = robot
            .constants
            .joints
            .iter()
            .map(|joint| {
                json!({
                    "name": joint.name, "called": joint.called, "nq": joint.nq, "nv": joint.nv,
                })
            })
            .collect();
        object["comparison"] = comparison(verdict, finding);
        object["with_mimic"] = match &finding.coupled {
            Some((_, Some(verdict))) => comparison(verdict, finding),
            Some((answer, None)) => answer.robot.as_ref().err().map_or(
                Value::Null,
                |unavailable| json!({ "message": vocabulary::unavailable(unavailable, answer.library) }),
            ),
            None => Value::Null,
        };
    }
    object
}

pub fn status(finding: &Finding) -> &'static str {
    match (&finding.answer.robot, &finding.verdict) {
        (Err(Unavailable::NotInstalled(_)), _) => "not installed",
        (Err(Unavailable::Refuses(_)), _) => "refused",
        (Err(Unavailable::Died(..)), _) => "no answer",
        (Ok(_), None) => "loaded",
        (Ok(_), Some(verdict)) if verdict.agrees() => "agrees",
        (Ok(_), Some(verdict)) if verdict.is_explained() => "explained",
        (Ok(_), Some(_)) => "unexplained",
    }
}

fn errors(errors: Errors) -> Value {
    let [M, g, h, tau] = errors.0;
    json!({ "mass_matrix": M, "gravity_forces": g, "bias_forces": h, "inverse_dynamics": tau })
}

fn comparison(verdict: &Verdict, finding: &Finding) -> Value {
    json!({
        "errors": errors(verdict.before),
        "errors_explained": errors(verdict.after),
        "causes": verdict.causes.iter().map(|found| {
            let mut object = cause(&found.cause);
            object["message"] = vocabulary::cause(&found.cause, &finding.answer).into();
            object["errors_without"] = errors(found.without);
            object
        }).collect::<Value>(),
        "extra_joints": verdict.extra.iter().map(|(name, nv)| json!({ "name": name, "nv": nv })).collect::<Value>(),
        "order": verdict.order,
        "first_difference": verdict.first.as_ref().map(|entry| json!({
            "quantity": entry.quantity, "state": entry.state, "joints": entry.joints,
            "mozzi": entry.mozzi, "theirs": entry.theirs,
        })),
    })
}

fn cause(cause: &Cause) -> Value {
    let changes = |kind: &str, list: &[Change]| {
        let entry = |change: &Change| json!({ "joint": change.joint, "mozzi": change.mozzi, "theirs": change.theirs });
        json!({ "kind": kind, "joints": list.iter().map(entry).collect::<Value>() })
    };
    match cause {
        Cause::Mimics(list) => json!({
            "kind": "mimic",
            "joints": list.iter().map(|freed| json!({ "joint": freed.joint, "source": freed.source })).collect::<Value>(),
        }),
        Cause::Held(list) => json!({ "kind": "held_joints", "joints": list }),
        Cause::Gravity { mozzi, theirs } => {
            json!({ "kind": "gravity", "mozzi": mozzi, "theirs": theirs })
        }
        Cause::Armature(list) => changes("armature", list),
        Cause::Damping(list) => changes("damping", list),
        Cause::Friction(list) => changes("friction", list),
        Cause::Stiffness(list) => changes("stiffness", list),
        Cause::Constraints(kinds) => json!({ "kind": "constraints", "constraints": kinds }),
        Cause::Force(name) => json!({ "kind": "force", "force": name }),
        Cause::Bodies(reason, list) => json!({
            "kind": "inertia",
            "reason": format!("{reason:?}").to_lowercase(),
            "bodies": list.iter().map(body).collect::<Value>(),
        }),
        Cause::Axes(list) => json!({
            "kind": "screw_axes",
            "joints": list.iter().map(|(name, axis)| json!({ "joint": name, "theirs": axis })).collect::<Value>(),
        }),
    }
}

fn body(change: &BodyChange) -> Value {
    let side = |inertia: &mozzi::SpatialInertia| {
        json!({
            "mass": inertia.mass,
            "center_of_mass": inertia.center_of_mass().0,
            "principal_moments": inertia.verdict().principal_moments,
        })
    };
    json!({ "joint": change.joint, "links": change.links, "mozzi": side(&change.mozzi), "theirs": side(&change.theirs) })
}
