//! A tree of hinges, a slide, a ball and a free joint, with springs, rotors, one of them turned by two joints, and a
//! mimic joint.

use crate::accuracy::robot::Robot;
use crate::accuracy::states::Kind;
use mozzi::Vec3;
use mozzi::model::description::{Gear, JointKind, Rotor};

/// Its name on the command line.
pub const NAME: &str = "mixed";

const TEXT: &str = include_str!("mixed.urdf");

/// The tree, on a fixed or a floating base.
///
/// # Errors
/// See [`Robot::parse`].
pub fn robot(floats: bool) -> Result<Robot, String> {
    let name = if floats { "mixed joints, floating" } else { "mixed joints" };
    Robot::parse_with(name, TEXT, floats, Kind::Ordinary, |robot| {
        for joint in &mut robot.joints {
            match joint.name.as_str() {
                "turn" => joint.armature = 0.03,
                "ball" => {
                    joint.kind = JointKind::Ball(Vec3([0.01, -0.02, 0.03]));
                    joint.armature = 0.01;
                }
                "free" => joint.armature = 0.07,
                _ => {}
            }
        }
        let gears = [("turn", 1.5), ("slide", -3.0)].map(|(joint, ratio)| Gear { joint: joint.into(), ratio });
        robot.rotors.push(Rotor { name: "differential".into(), armature: 0.02, gears: gears.into() });
    })
}
