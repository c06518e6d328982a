//! The robot that a command is about.

use crate::failure::{self, Result};
use crate::numbers::array;
use clap::Args;
use mozzi::{FrameId, Model};

/// More are counted: `mozzi check` shows them, each with its place.
const WARNINGS: usize = 3;

#[derive(Args, Debug)]
pub struct RobotArguments {
    /// A URDF file, or an embedded robot: double_pendulum, furuta_pendulum, panda, two_link_planar, ur5
    pub model: String,
    /// The frame whose pose, Jacobians and wrench are meant; where the chain branches it has to be named
    #[arg(long, value_name = "FRAME")]
    pub end_effector: Option<String>,
    /// Gravity in base coordinates, m/s² [default: the robot's own, 0,0,-9.81]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub gravity: Option<String>,
    /// Print one JSON object, every digit of every number, instead of text
    #[arg(long)]
    pub json: bool,
}

impl RobotArguments {
    /// Loads the robot, saying what is odd about it.
    pub fn load(&self) -> Result<Model> {
        let loaded = mozzi_urdf::open(&self.model)?;
        let warnings = &loaded.warnings;
        warnings.iter().take(WARNINGS).for_each(|warning| failure::write(&format!("{warning}\n")));
        if warnings.len() > WARNINGS {
            failure::note(&format!("{} warnings in all; `mozzi check {}` shows them", warnings.len(), self.model));
        }
        let mut model = loaded.build()?;
        if let Some(text) = &self.gravity {
            model = model.with_gravity(array("--gravity", text, ["x", "y", "z"])?)?;
        }
        if let Some(name) = &self.end_effector {
            model = model.with_end_effector(model.frame(name)?)?;
        }
        Ok(model)
    }
}

/// The end effector, or `None` with a note on what is left out.
pub fn end_effector(model: &Model) -> Option<FrameId> {
    match model.end_effector() {
        Ok(frame) => Some(frame),
        Err(error) => {
            failure::note(&format!("{error}; without --end-effector, what needs it is left out"));
            None
        }
    }
}

/// "rad" and "N m", "m" and "N", or both where the robot has joints of both kinds.
pub struct Units {
    pub position: &'static str,
    pub force: &'static str,
    pub inertia: &'static str,
}

impl Units {
    pub fn of(model: &Model) -> Self {
        let slides = model.joints().filter(|joint| joint.kind.name() == "prismatic").count();
        match slides {
            0 => Units { position: "rad", force: "N m", inertia: "kg m²" },
            all if all == model.n() => Units { position: "m", force: "N", inertia: "kg" },
            _ => Units { position: "rad, m", force: "N m, N", inertia: "kg m², kg m, kg" },
        }
    }

    /// Per second, per second squared.
    pub fn rate(&self, order: usize) -> String {
        let per = ["", "/s", "/s²"][order.min(2)];
        self.position.split(", ").map(|unit| format!("{unit}{per}")).collect::<Vec<_>>().join(", ")
    }
}
