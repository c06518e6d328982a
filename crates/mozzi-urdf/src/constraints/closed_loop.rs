//! `robot.yaml` of Gepetto's parallel robots: pairs of frames that coincide, and the motors.

use super::entry::check;
use super::file::Contents;
use crate::json::{At, Object, Read};
use mozzi::model::description::{Anchor, Closure, Constraint, Joint, JointKind};
use mozzi::{Description, Vec3};

const FILE: Object = Object::of(&["closed_loop"]).optional(&["type", "name_mot", "joint_name", "joint_type"]);

pub fn contents(at: &At, robot: &Description) -> Read<Contents> {
    check(&FILE, at)?;
    let pairs = at.get("closed_loop").list()?;
    let kinds = at.get("type");
    // without types, the frames coincide
    let each = kinds.some(At::list)?.unwrap_or_default();
    if each.len() != pairs.len() && !kinds.value.is_null() {
        return kinds.wrong(format_args!("one type for each pair of closed_loop ({})", pairs.len()));
    }
    let mut constraints = Vec::new();
    for (k, pair) in pairs.iter().enumerate() {
        let ends = pair.list()?;
        let [a, b] = ends.as_slice() else { return pair.wrong("two frames") };
        let name = format!("{}-{}", a.text()?, b.text()?);
        let kind = each.get(k).map(At::text).transpose()?.map(|kind| kind.to_lowercase());
        let closure = match (kind.as_deref(), each.get(k)) {
            (None | Some("6d"), _) => Closure::Weld,
            (Some("3d"), _) => Closure::Point,
            (_, wrong) => return wrong.unwrap_or(&kinds).wrong("`6d`, frames that coincide, or `3d`, points that do"),
        };
        constraints.push((Constraint::new(name, anchor(a, robot)?, anchor(b, robot)?, closure), pair.position()));
    }
    let driven = at.get("name_mot");
    Ok(Contents { constraints, motors: driven_joints(&driven, robot)?, place_of_motors: driven.position() })
}

/// Joints whose type changes: the lists `joint_name` and `joint_type`, of the same length.
pub fn retyped(at: &At, robot: &Description) -> Read<Vec<(usize, JointKind)>> {
    let list = |key| Read::Ok(at.get(key).some(At::list)?.unwrap_or_default());
    let (names, types) = (list("joint_name")?, list("joint_type")?);
    if names.len() != types.len() {
        return at.get("joint_type").wrong(format_args!("one type for each joint of joint_name ({})", names.len()));
    }
    let each = names.iter().zip(&types).map(|(name, kind)| {
        let joint = name.text()?;
        let Some(index) = robot.joints.iter().position(|known| known.name == joint) else {
            return name.error(format_args!("{} is `{joint}`, expected a joint of the robot", name.name()));
        };
        match kind.text()?.to_uppercase().as_str() {
            "SPHERICAL" => Ok((index, JointKind::Ball(Vec3::zero()))),
            "FIXED" => Ok((index, JointKind::Fixed)),
            "REVOLUTE" | "PRISMATIC" | "CONTINUOUS" => Ok((index, robot.joints[index].kind)),
            _ => kind.wrong("SPHERICAL, FIXED, or REVOLUTE, PRISMATIC and CONTINUOUS as in the robot's file"),
        }
    });
    each.collect()
}

/// The joints with motors: a list of names, or a part that their names have. A motor of a mimic joint drives the joint
/// that it follows.
fn driven_joints(at: &At, robot: &Description) -> Read<Option<Vec<String>>> {
    let named = match at.text() {
        Ok(part) => {
            let moves = |joint: &&Joint| joint.kind != JointKind::Fixed && joint.mimic.is_none();
            let all = robot.joints.iter().filter(moves).map(|joint| joint.name.clone());
            Some(all.filter(|name| name.contains(&part)).collect())
        }
        Err(_) => at.some(At::texts)?,
    };
    let Some(named): Option<Vec<String>> = named else { return Ok(None) };
    let mut driven: Vec<String> = Vec::new();
    for mut name in named {
        // as often as there are joints, since circles of mimic joints are reported elsewhere
        for _ in 0..robot.joints.len() {
            let joint = robot.joints.iter().find(|joint| joint.name == name);
            let Some(mimic) = joint.and_then(|joint| joint.mimic.as_ref()) else { break };
            name.clone_from(&mimic.joint);
        }
        if !driven.contains(&name) {
            driven.push(name);
        }
    }
    Ok(Some(driven))
}

/// The frame of this name or, if there is none, the child frame of the joint of this name.
fn anchor(at: &At, robot: &Description) -> Read<Anchor> {
    let name = at.text()?;
    let is_frame =
        robot.links.iter().any(|link| link.name == name) || robot.frames.iter().any(|frame| frame.name == name);
    match robot.joints.iter().find(|joint| joint.name == name) {
        Some(joint) if !is_frame => Ok(Anchor::frame(&joint.child)),
        None if !is_frame => {
            at.error(format_args!("{} is `{name}`, expected a link, frame or joint of the robot", at.name()))
        }
        _ => Ok(Anchor::frame(name)),
    }
}
