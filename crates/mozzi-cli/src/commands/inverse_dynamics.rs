//! `mozzi inverse-dynamics`: τ from θ̈, of one state or of a table of states.

use super::trajectories::{self, TableArguments};
use crate::failure::Result;
use crate::json;
use crate::robot::{RobotArguments, Units};
use crate::state::{StartArguments, TipArguments, environment, velocities};
use crate::table::{Quantity, quantities};
use clap::Args;
use serde_json::json;

#[derive(Args, Debug)]
pub struct InverseArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Accelerations θ̈, rad/s² or m/s² [default: all 0]
    #[arg(long, value_name = "θ̈1,θ̈2,…", allow_hyphen_values = true, conflicts_with = "input")]
    ddtheta: Option<String>,
    #[command(flatten)]
    tip: TipArguments,
    #[command(flatten)]
    table: TableArguments,
}

pub fn run(arguments: &InverseArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    if arguments.table.input.is_some() {
        let names = ("ddtheta", "tau", "inverse_dynamics");
        return trajectories::run(&model, &arguments.table, arguments.robot.json, names, |row| {
            let environment = environment(&model, &row.applied);
            Ok(model.inverse_dynamics(row.theta, row.dtheta, row.given, &environment)?.as_slice().to_vec())
        });
    }
    let (theta, dtheta) = arguments.start.read(&model)?;
    let ddtheta = velocities("--ddtheta", arguments.ddtheta.as_deref(), &model)?;
    let applied = arguments.tip.read(&model)?;
    let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment(&model, &applied))?;
    if arguments.robot.json {
        return Ok(json::print(&json::of_robot(
            &model,
            json!({
                "theta": json::vector(&theta),
                "dtheta": json::vector(&dtheta),
                "ddtheta": json::vector(&ddtheta),
                "F_tip": applied.first().map(|(_, F)| json::vector(&F.to_array())),
                "inverse_dynamics": json::dvector(&tau),
            }),
        )));
    }
    let units = Units::of(&model);
    let lines = quantities(
        &model,
        &[
            Quantity::new("θ", "positions", units.rate(0), &theta),
            Quantity::new("θ̇", "velocities", units.rate(1), &dtheta),
            Quantity::new("θ̈", "accelerations", units.rate(2), &ddtheta),
            Quantity::new("τ", "inverse_dynamics", units.force, tau.as_slice()),
        ],
        false,
    );
    Ok(lines.join("\n") + "\n")
}
