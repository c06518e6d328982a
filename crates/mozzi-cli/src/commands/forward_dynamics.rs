//! `mozzi forward-dynamics`: θ̈ from τ, of one state or of a table of states.

use super::trajectories::{self, TableArguments};
use crate::failure::Result;
use crate::json;
use crate::robot::{RobotArguments, Units};
use crate::state::{StartArguments, TipArguments, environment, velocities};
use crate::table::{Quantity, quantities};
use clap::{Args, ValueEnum};
use mozzi::{Environment, Model};
use nalgebra::DVector;
use serde_json::json;

#[derive(Args, Debug)]
pub struct ForwardArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Forces τ of the motors, N m or N [default: all 0]
    #[arg(long, value_name = "τ1,τ2,…", allow_hyphen_values = true, conflicts_with = "input")]
    tau: Option<String>,
    #[command(flatten)]
    tip: TipArguments,
    #[command(flatten)]
    table: TableArguments,
    /// How M θ̈ = τ − h − JᵀF − f is solved
    #[arg(long, value_name = "WAY", default_value = "articulated-body")]
    algorithm: Way,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Way {
    /// Articulated bodies, O(n)
    ArticulatedBody,
    /// Composite rigid bodies, then the factors of M along the tree
    MassMatrix,
    /// The book's: h by one call of inverse dynamics, M by n calls, then Cholesky
    InverseDynamics,
}

impl Way {
    fn solve(
        self,
        model: &Model,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> std::result::Result<DVector<f64>, mozzi::Error> {
        match self {
            Way::ArticulatedBody => model.forward_dynamics(theta, dtheta, tau, environment),
            Way::MassMatrix => model.forward_dynamics_by_mass_matrix(theta, dtheta, tau, environment),
            Way::InverseDynamics => model.forward_dynamics_by_inverse_dynamics(theta, dtheta, tau, environment),
        }
    }
}

pub fn run(arguments: &ForwardArguments) -> Result<String> {
    let (model, by) = (arguments.robot.load()?, arguments.algorithm);
    if arguments.table.input.is_some() {
        let names = ("tau", "ddtheta", "forward_dynamics");
        return trajectories::run(&model, &arguments.table, arguments.robot.json, names, |row| {
            let environment = environment(&model, &row.applied);
            Ok(by.solve(&model, row.theta, row.dtheta, row.given, &environment)?.as_slice().to_vec())
        });
    }
    let (theta, dtheta) = arguments.start.read(&model)?;
    let tau = velocities("--tau", arguments.tau.as_deref(), &model)?;
    let applied = arguments.tip.read(&model)?;
    let ddtheta = by.solve(&model, &theta, &dtheta, &tau, &environment(&model, &applied))?;
    if arguments.robot.json {
        return Ok(json::print(&json::of_robot(
            &model,
            json!({
                "theta": json::vector(&theta),
                "dtheta": json::vector(&dtheta),
                "tau": json::vector(&tau),
                "F_tip": applied.first().map(|(_, F)| json::vector(&F.to_array())),
                "forward_dynamics": json::dvector(&ddtheta),
            }),
        )));
    }
    let units = Units::of(&model);
    let lines = quantities(
        &model,
        &[
            Quantity::new("θ", "positions", units.rate(0), &theta),
            Quantity::new("θ̇", "velocities", units.rate(1), &dtheta),
            Quantity::new("τ", "forces of the motors", units.force, &tau),
            Quantity::new("θ̈", "forward_dynamics", units.rate(2), ddtheta.as_slice()),
        ],
        false,
    );
    Ok(lines.join("\n") + "\n")
}
