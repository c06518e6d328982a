//! `mozzi terms`: every quantity of the dynamics at one state.

mod json;
mod stacked;
pub mod text;
pub mod values;

use crate::failure::Result;
use crate::json::print;
use crate::robot::RobotArguments;
use crate::state::{Motion, MotionArguments, environment};
use crate::task::TaskArguments;
use clap::Args;
use values::Terms;

#[derive(Args, Debug)]
pub struct TermsArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    motion: MotionArguments,
    #[command(flatten)]
    task: TaskArguments,
    /// Also show the matrices of the closed form: 𝒜 𝒢 𝒲 ℒ [ad_𝒱] [ad_𝒜θ̇] 𝒱 𝒱̇ 𝓕
    #[arg(long)]
    stacked: bool,
}

pub fn run(arguments: &TermsArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let Motion { state, applied } = arguments.motion.read(&model)?;
    let environment = environment(&model, &applied);
    let mut terms = Terms::at(&model, state, &environment)?;
    terms.add_task(&arguments.task, &environment)?;
    if arguments.stacked {
        terms.closed_form = Some(model.closed_form(&terms.theta, &terms.dtheta, &environment)?);
    }
    Ok(if arguments.robot.json { print(&json::object(&terms)) } else { text::page(&terms) })
}
