//! Other masses, inertias and frictions, pinned frames, another base: the description with these changes.

use super::entry::{number, text, three};
use crate::robot::Robot;
use mozzi::model::description::{Anchor, Constraint, JointKind};
use mozzi::{Base, Description, Model, SE3, SpatialInertia, Sym3};
use mozzi_urdf::json;
use serde_json::{Value, json};

/// The prefix of constraints that pins add.
const PIN: &str = "pin ";

/// Mass, centre and inertia about it of each link, damping and friction of each joint, the pinned frames.
pub fn numbers(model: &Model) -> Result<Value, String> {
    let robot = model.described().map_err(|error| error.to_string())?;
    let links = robot.links.iter().map(|link| {
        let Sym3 { xx, xy, xz, yy, yz, zz } = link.inertia.about_center_of_mass();
        json!({
            "name": link.name, "mass": link.inertia.mass, "center": link.inertia.center_of_mass().0,
            "inertia": [xx, xy, xz, yy, yz, zz], "isPhysical": link.inertia.verdict().is_physical(),
        })
    });
    let joints = robot.joints.iter().filter(|joint| joint.kind != JointKind::Fixed).map(|joint| {
        json!({
            "name": joint.name, "damping": joint.damping, "friction": joint.friction, "armature": joint.armature,
        })
    });
    let pins = robot.constraints.iter().filter_map(|constraint| constraint.name.strip_prefix(PIN));
    Ok(json!({
        "links": links.collect::<Value>(), "joints": joints.collect::<Value>(), "pins": pins.collect::<Value>(),
        "gravity": robot.gravity,
    }))
}

/// The description after a change, as JSON of [`mozzi_urdf::json`]. The robot itself stays as it is.
pub fn edit(robot: &Robot, command: &Value) -> Result<Value, String> {
    let mut changed = robot.model().described().map_err(|error| error.to_string())?;
    match text(command, "what")? {
        "link" => link(&mut changed, command)?,
        "joint" => joint(&mut changed, command)?,
        "gravity" => changed.gravity = three(command, "gravity")?,
        "floating" => {
            changed = changed.floating();
            (changed.states, changed.start) = (Vec::new(), None);
        }
        "fixed" => {
            (changed.base, changed.states, changed.start) = (Base::Fixed, Vec::new(), None);
            changed.constraints.retain(|constraint| !constraint.name.starts_with(PIN));
        }
        "pin" => pin(&mut changed, robot, text(command, "frame")?)?,
        "unpin" => {
            let name = format!("{PIN}{}", text(command, "frame")?);
            changed.constraints.retain(|constraint| constraint.name != name);
        }
        other => return Err(format!("`{other}` cannot be edited")),
    }
    changed.clone().build().map_err(|error| error.to_string())?;
    Ok(json::to_value(&changed))
}

/// One number of a link: its mass, with `scale` also its inertia, a coordinate of its centre, an entry of its inertia.
fn link(robot: &mut Description, command: &Value) -> Result<(), String> {
    let name = text(command, "name")?;
    let link = robot.links.iter_mut().find(|link| link.name == name);
    let link = link.ok_or_else(|| format!("there is no link `{name}`"))?;
    let (mut mass, mut c) = (link.inertia.mass, link.inertia.center_of_mass());
    let mut I = link.inertia.about_center_of_mass();
    let value = number(command, "value")?;
    match text(command, "entry")? {
        "mass" => {
            if mass > 0.0 && command["scale"] == true {
                I = I * (value / mass);
            }
            mass = value;
        }
        entry @ ("x" | "y" | "z") => c.0[usize::from(entry.as_bytes()[0] - b'x')] = value,
        "xx" => I.xx = value,
        "xy" => I.xy = value,
        "xz" => I.xz = value,
        "yy" => I.yy = value,
        "yz" => I.yz = value,
        "zz" => I.zz = value,
        other => return Err(format!("a link has no `{other}`")),
    }
    link.inertia = SpatialInertia::new(mass, c, I);
    Ok(())
}

/// One number of a joint, or of all joints without a name.
fn joint(robot: &mut Description, command: &Value) -> Result<(), String> {
    let (name, value) = (command["name"].as_str(), number(command, "value")?);
    let entry = text(command, "entry")?;
    let is_meant = |joint: &&mut mozzi::model::description::Joint| {
        joint.kind != JointKind::Fixed && name.is_none_or(|name| joint.name == name)
    };
    for joint in robot.joints.iter_mut().filter(is_meant) {
        match entry {
            "damping" => joint.damping = value,
            "friction" => joint.friction = value,
            "armature" => joint.armature = value,
            other => return Err(format!("a joint has no `{other}`")),
        }
    }
    Ok(())
}

/// Welds a frame to {s} where it is. The motors of a floating base are then named, so that gravity compensation knows
/// that the base has none.
fn pin(changed: &mut Description, robot: &Robot, frame: &str) -> Result<(), String> {
    let said = |error: mozzi::Error| error.to_string();
    let model = robot.model();
    let T: SE3 = model.forward_kinematics(robot.theta(), model.frame(frame).map_err(said)?).map_err(said)?;
    let name = format!("{PIN}{frame}");
    changed.constraints.retain(|constraint| constraint.name != name);
    changed.constraints.push(Constraint::weld(name, Anchor::world(T), Anchor::frame(frame)));
    if changed.base == Base::Floating && changed.motors.is_none() {
        changed.motors = Some(model.joints().map(|joint| joint.name.clone()).collect());
    }
    Ok(())
}
