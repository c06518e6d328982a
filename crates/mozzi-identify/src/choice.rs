//! Which parameters are estimated; the others keep the robot's values.

use crate::signals::Shape;
use mozzi::FrameId;

/// Where forces are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensor {
    /// By the motor's current or a sensor before the gear: the rotor's inertia is part of the force.
    #[default]
    Motor,
    /// Behind the gear: the rotor's inertia is not in the force. Friction is fitted all the same: bearings and cables
    /// remain.
    Link,
}

/// Which parameters are estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The ten inertial parameters of each moving link.
    pub links: bool,
    /// Rotor inertia.
    pub armature: bool,
    /// Viscous friction.
    pub viscous: bool,
    /// Coulomb friction μ tanh(θ̇/w).
    pub coulomb: bool,
    /// w: the velocity at which Coulomb friction reaches 76 % of its value, rad/s or m/s.
    pub width: f64,
    /// Stribeck friction ν exp(−(θ̇/v)²) tanh(θ̇/w), with this v, rad/s or m/s.
    pub stribeck: Option<f64>,
    /// A constant force for each joint, of sensors and of cables.
    pub offset: bool,
    /// Stiffness of springs. Their preload is the file's; what comes beyond it is in the offset.
    pub stiffness: bool,
    /// The ten parameters of a payload fixed to this frame.
    pub payload: Option<FrameId>,
    /// Estimate apparent inertias and dampings of either sign, which stand for friction with memory, friction that
    /// falls with speed, and delays. Predictions contain them; the robot gets the part that is physically possible.
    pub apparent: bool,
    /// Drive gains K, if `tau` holds motor currents i: τ = K i. They need a log with a known payload.
    pub gains: bool,
}

impl Default for Choice {
    /// Links, viscous and Coulomb friction, offsets, and armature: torque measured at the motor.
    fn default() -> Self {
        Choice::all(Sensor::Motor)
    }
}

impl Choice {
    /// Links, viscous and Coulomb friction and offsets; armature if torque is measured at the motor.
    pub fn all(sensor: Sensor) -> Self {
        Choice {
            links: true,
            armature: sensor == Sensor::Motor,
            viscous: true,
            coulomb: true,
            width: 0.05,
            stribeck: None,
            offset: true,
            stiffness: false,
            payload: None,
            apparent: true,
            gains: false,
        }
    }

    /// The joints alone, friction and offsets; the robot's masses are trusted. Armature, too, if torque is measured at
    /// the motor: few files have it.
    pub fn only_friction(sensor: Sensor) -> Self {
        Choice { links: false, apparent: false, ..Choice::all(sensor) }
    }

    /// A payload at a frame, with the joints' parameters.
    pub fn only_payload(frame: FrameId, sensor: Sensor) -> Self {
        Choice { payload: Some(frame), ..Choice::only_friction(sensor) }
    }

    /// True if apparent inertias and dampings are separated from the robot's. With trusted links they would hide wrong
    /// masses, with unknown gains everything.
    pub fn is_apparent(&self) -> bool {
        self.apparent && self.links && !self.gains
    }

    /// The shape of dry friction.
    pub fn shape(&self) -> Shape {
        Shape { width: self.width, stribeck: self.stribeck }
    }
}
