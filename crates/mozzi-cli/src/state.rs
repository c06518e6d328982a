//! One state of a robot, by flags.

use crate::failure::Result;
use crate::numbers::{WRENCH, array, numbers_for};
use clap::Args;
use mozzi::{Environment, FrameId, Model, Wrench};

#[derive(Args, Debug, Default)]
pub struct StartArguments {
    /// Joint positions θ, rad or m [default: all 0]
    #[arg(long, value_name = "θ1,θ2,…", allow_hyphen_values = true)]
    pub theta: Option<String>,
    /// Joint velocities θ̇, rad/s or m/s [default: all 0]
    #[arg(long, value_name = "θ̇1,θ̇2,…", allow_hyphen_values = true)]
    pub dtheta: Option<String>,
}

#[derive(Args, Debug, Default)]
pub struct TipArguments {
    /// What the end effector applies to the environment, in its own frame, moment first: N m, N [default: 0]
    #[arg(long, value_name = "mx,my,mz,fx,fy,fz", allow_hyphen_values = true)]
    pub tip_wrench: Option<String>,
}

impl StartArguments {
    /// (θ, θ̇).
    pub fn read(&self, model: &Model) -> Result<(Vec<f64>, Vec<f64>)> {
        Ok((
            joint_values("--theta", self.theta.as_deref(), model)?,
            joint_values("--dtheta", self.dtheta.as_deref(), model)?,
        ))
    }
}

impl TipArguments {
    /// The wrench with its frame; an error where there is a wrench and no end effector.
    pub fn read(&self, model: &Model) -> Result<Vec<(FrameId, Wrench)>> {
        match &self.tip_wrench {
            None => Ok(Vec::new()),
            Some(text) => Ok(vec![(model.end_effector()?, Wrench::from_array(array("--tip-wrench", text, WRENCH)?))]),
        }
    }
}

/// One number for each joint; zeros where the flag is not given.
pub fn joint_values(flag: &str, text: Option<&str>, model: &Model) -> Result<Vec<f64>> {
    let names: Vec<&str> = model.joint_names().collect();
    match text {
        None => Ok(vec![0.0; names.len()]),
        Some(text) => numbers_for(flag, text, names.iter().copied()),
    }
}

/// The model's gravity, and what the robot applies.
pub fn environment<'a>(model: &Model, applied: &'a [(FrameId, Wrench)]) -> Environment<'a> {
    Environment { applied, ..model.environment() }
}
