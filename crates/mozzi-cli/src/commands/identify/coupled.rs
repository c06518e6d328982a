//! Rotors that several joints turn: `--coupled`.

use crate::failure::{Failure, Result};
use crate::numbers::number;
use mozzi::Model;
use mozzi::model::description::{Gear, Rotor};

/// The robot with the rotors of `--coupled`.
pub fn with_rotors(robot: &Model, coupled: &[String]) -> Result<Model> {
    if coupled.is_empty() {
        return Ok(robot.clone());
    }
    let mut description = robot.description().clone();
    for text in coupled {
        let mut gears = Vec::new();
        for part in text.split(',') {
            let (joint, ratio) = match part.split_once('=') {
                Some((joint, ratio)) => (joint.trim(), number(format!("--coupled {joint}"), ratio)?),
                None => (part.trim(), 1.0),
            };
            if !description.joints.iter().any(|one| one.name == joint) {
                let names: Vec<&str> = robot.joint_names().collect();
                return Err(Failure::wrong(format!(
                    "--coupled {text}: there is no joint `{joint}`; the robot has {}",
                    names.join(", ")
                )));
            }
            gears.push(Gear { joint: joint.to_string(), ratio });
        }
        if gears.len() < 2 {
            return Err(Failure::wrong(format!("--coupled {text}: one joint, expected two or more with commas")));
        }
        let name = gears.iter().map(|gear| gear.joint.as_str()).collect::<Vec<_>>().join("+");
        description.rotors.push(Rotor { name, armature: 0.0, gears });
    }
    Ok(description.build()?)
}
