//! Limits of joints that are reversed, or forbid every effort.

use super::inertial::shortest;
use super::{Proposal, Robot, twin};
use crate::edit::element::{Editor, Tag};
use crate::text::number::numbers;
use crate::text::version::Version;

pub(super) fn proposals(robot: &Robot<'_>) -> Vec<Proposal> {
    let joints: Vec<Tag<'_>> = robot.root.children().filter(|tag| tag.name() == "joint").collect();
    let mut all = Vec::new();
    for &joint in &joints {
        all.extend(reversed(robot, joint));
        all.extend(without_effort(robot, joint, &joints));
    }
    all
}

fn number(joint: Tag<'_>, name: &str) -> Option<f64> {
    numbers::<1>(joint.child("limit")?.attribute(name)?).ok().map(|[x]| x)
}

fn reversed(robot: &Robot<'_>, joint: Tag<'_>) -> Option<Proposal> {
    let limit = joint.child("limit")?;
    let version = robot.root.attribute("version").and_then(Version::parse).unwrap_or_default();
    let default = Some("0").filter(|_| version < Version::WITH_ACCELERATION);
    let [low, high] = ["lower", "upper"].map(|name| limit.attribute(name).or(default));
    let [lower, upper] = [low, high].map(|text| numbers::<1>(text?).ok().map(|[x]| x));
    let (lower, upper) = (lower?, upper?);
    if lower <= upper || !matches!(joint.attribute("type"), Some("revolute" | "prismatic")) {
        return None;
    }
    let mut editor = Editor::new(joint.text);
    editor.set(limit, "lower", high);
    editor.set(limit, "upper", low);
    let mut proposal = robot.proposal("reversed_limit", joint, &editor);
    let [low, high] = [lower, upper].map(shortest);
    proposal.change = format!("lower {low} → {high}, upper {high} → {low}");
    proposal.reason = "the lower limit is above the upper one".to_string();
    Some(proposal)
}

/// The effort of the joint on the other side, or the one that all other joints of this kind and speed have. A joint
/// whose name differs only in a number is no evidence: the wrist of an arm has less than its shoulder.
fn without_effort(robot: &Robot<'_>, joint: Tag<'_>, joints: &[Tag<'_>]) -> Option<Proposal> {
    let kind = joint.attribute("type").filter(|kind| matches!(*kind, "revolute" | "prismatic" | "continuous"))?;
    // a follower and a spring need no motor
    let is_passive = joint.child("mimic").is_some()
        || joint.child("dynamics").is_some_and(|dynamics| dynamics.attribute("spring_stiffness").is_some());
    if number(joint, "effort") != Some(0.0) || is_passive {
        return None;
    }
    let others = || joints.iter().filter(|other| other.attribute("type") == Some(kind) && other.node != joint.node);
    let effort = |other: &Tag<'_>| number(*other, "effort").filter(|effort| *effort > 0.0);
    let names = twin::mirrored(joint.attribute("name")?);
    let twin = names.iter().find_map(|name| {
        let other = others().find(|other| other.attribute("name") == Some(name.as_str()))?;
        let is_as_fast = number(*other, "velocity") == number(joint, "velocity");
        Some((effort(other).filter(|_| is_as_fast)?, format!("joint `{name}`, its counterpart, has this one")))
    });
    let alike = || {
        let velocity = number(joint, "velocity")?;
        let same = others().filter(|other| number(**other, "velocity") == Some(velocity));
        let efforts: Vec<f64> = same.map(|other| number(*other, "effort").unwrap_or(0.0)).collect();
        let first = *efforts.first().filter(|first| **first > 0.0)?;
        let is_one = efforts.len() > 1 && efforts.iter().all(|effort| *effort == first);
        is_one.then(|| (first, "all other joints of its kind and speed have this one".to_string()))
    };
    let (effort, evidence) = twin.or_else(alike)?;
    let mut editor = Editor::new(joint.text);
    editor.set(joint.child("limit")?, "effort", Some(&shortest(effort)));
    let mut proposal = robot.proposal("zero_effort", joint, &editor);
    proposal.change = format!("effort 0 → {}", shortest(effort));
    proposal.reason = format!("a limit of effort of 0 forbids every torque; {evidence}");
    Some(proposal)
}
