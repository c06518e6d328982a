//! `robot.yaml` of Gepetto's parallel robots: pairs of frames that coincide, and the motors.

use super::entry::{Entry, known, motors, required};
use super::file::{At, Contents};
use super::yaml::Wrong;
use mozzi::Description;
use mozzi::model::description::{Anchor, Closure, Constraint};

pub fn contents(at: &At, robot: &Description) -> Result<Contents, Wrong> {
    known(at, &["closed_loop", "type", "name_mot"])?;
    let (pairs, kinds) = (required(at, "closed_loop")?.list()?, required(at, "type")?);
    let each = kinds.list()?;
    if each.len() != pairs.len() {
        return kinds.wrong(&format!("one type for each of the {} pairs of closed_loop", pairs.len()));
    }
    let mut constraints = Vec::new();
    for (pair, kind) in pairs.iter().zip(&each) {
        let ends = pair.list()?;
        let [a, b] = ends.as_slice() else { return pair.wrong("two frames") };
        let name = format!("{}-{}", a.text()?, b.text()?);
        let closure = match kind.text()?.as_str() {
            "6d" => Closure::Weld,
            "3d" => Closure::Point,
            _ => return kind.wrong("`6d`, frames that coincide, or `3d`, points that do"),
        };
        constraints.push((Constraint::new(name, anchor(a, robot)?, anchor(b, robot)?, closure), pair.place));
    }
    let driven = at.get("name_mot");
    Ok(Contents { constraints, motors: motors(&driven)?, place_of_motors: driven.place })
}

/// The frame of this name or, if there is none, the child frame of the joint of this name.
fn anchor(at: &At, robot: &Description) -> Result<Anchor, Wrong> {
    let name = at.text()?;
    let is_frame =
        robot.links.iter().any(|link| link.name == name) || robot.frames.iter().any(|frame| frame.name == name);
    match robot.joints.iter().find(|joint| joint.name == name) {
        Some(joint) if !is_frame => Ok(Anchor::frame(&joint.child)),
        None if !is_frame => {
            at.error(format!("{} is `{name}`, expected a link, frame or joint of the robot", at.name()))
        }
        _ => Ok(Anchor::frame(name)),
    }
}
