//! `mozzi compute`: any quantity, at one state or at every state of a table.

mod flags;
mod gpu;
mod list;
mod one_state;
mod subject;
mod table;

use super::assemble::{needs_constraints, violation};
use crate::failure::{self, Failure, Result};
use crate::inputs::{InputArguments, STATE};
use crate::json;
use crate::numbers::array;
use crate::quantity::{hyphenated, of_end_effector, quantity};
use crate::robot::RobotArguments;
use crate::state::WrenchArguments;
use crate::task::TaskArguments;
use crate::text::about;
use crate::workload;
use clap::{Arg, Args};
use mozzi::quantities::{Dim, INPUTS, LIST, Of, Query};
use mozzi::{Environment, Model, Task, Vec3};
use table::{Job, TableArguments};

#[derive(Args, Debug)]
pub struct ComputeArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// The quantity to compute
    #[arg(index = 2, value_parser = quantity(), required_unless_present = "list")]
    quantity: Option<Query<'static>>,
    /// List all quantities: names, formulas, inputs, outputs
    #[arg(long)]
    list: bool,
    /// The vector-Jacobian product of the quantity: the gradient of xᵀ or wᵀ times it, with the vector in --x or --w
    #[arg(long)]
    vjp: bool,
    #[command(flatten)]
    inputs: InputArguments,
    #[command(flatten)]
    task: TaskArguments,
    /// Reference point of the momentum in {s}, m [default: the origin]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    about: Option<String>,
    #[command(flatten)]
    wrenches: WrenchArguments,
    #[command(flatten)]
    table: TableArguments,
}

/// The list needs no model.
pub fn model(model: Arg) -> Arg {
    model.index(1).required(false).required_unless_present("list").default_value("").hide_default_value(true)
}

pub fn run(arguments: &ComputeArguments) -> Result<String> {
    let query = match arguments.quantity {
        Some(query) if !arguments.list && arguments.vjp => vjp_of(query)?,
        Some(query) if !arguments.list => query,
        _ => return Ok(list::page()),
    };
    arguments.check_flags(query)?;
    let model = arguments.robot.load()?;
    let squares = query.declaration().outputs.iter().any(|output| output.dims.starts_with(&[Dim::N, Dim::N]));
    if squares {
        workload::matrices(&model)?;
    }
    let rows = arguments.task.rows()?;
    let query = arguments.subject(query, &rows, &model)?;
    let applied = arguments.wrenches.read(&model)?;
    let environment = Environment { applied: &applied, ..model.environment() };
    check_constraints(query, &model)?;
    if let Some(file) = &arguments.table.input {
        let (model, table, robot) = (&model, &arguments.table, &arguments.robot);
        return Job { file, query, model, environment, table, robot }.run();
    }
    let inputs = arguments.inputs.read(query.declaration(), &model)?;
    let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    if query.declaration().is_constrained {
        let open = violation(&model, slices[0])?;
        if open > 1e-6 {
            failure::note(&format!("θ violates the constraints by {}; `mozzi assemble` closes them", about(open)));
        }
    }
    let outputs = model.compute(query, &slices, &environment)?;
    Ok(match arguments.robot.json {
        true => json::print(&one_state::object(query, &model, &slices, &environment, &outputs)),
        false => one_state::page(query, &model, &slices, &environment, &outputs),
    })
}

/// The quantity that is the vector-Jacobian product of this one.
fn vjp_of(query: Query<'static>) -> Result<Query<'static>> {
    Query::named(&format!("{}_vjp", query.name())).map_err(|_| {
        let known: Vec<String> =
            LIST.iter().filter_map(|known| known.name.strip_suffix("_vjp")).map(hyphenated).collect();
        Failure::wrong(format!(
            "--vjp: {} has no vector-Jacobian product, expected one of {}",
            hyphenated(query.name()),
            known.join(", ")
        ))
    })
}

/// Checks that there are constraints if they are needed, and prints a note if they are left out.
fn check_constraints(query: Query, model: &Model) -> Result<()> {
    if query.declaration().is_constrained {
        needs_constraints(model)?;
    }
    if model.constraint_rows() > 0 && query.name().starts_with("forward_dynamics") {
        failure::note(
            "the robot's constraints do not act in this quantity; `constrained-forward-dynamics` applies them",
        );
    }
    Ok(())
}

impl ComputeArguments {
    /// Checks that every given flag has an effect.
    fn check_flags(&self, query: Query) -> Result<()> {
        let used = flags::of(query.declaration());
        let tip_wrench = self.wrenches.tip.tip_wrench.is_some();
        let is_of_tip = used.contains(&"tip-wrench") && (tip_wrench || self.table.input.is_some());
        let others = [
            (STATE, self.inputs.has(STATE)),
            ("frame", self.robot.end_effector.is_some() && !is_of_tip),
            ("task", self.task.task.is_some()),
            ("task-frame", self.task.task_frame.is_some()),
            ("about", self.about.is_some()),
            ("tip-wrench", tip_wrench),
            ("wrench", !self.wrenches.wrench.is_empty()),
            ("gravity", self.robot.gravity.is_some()),
        ];
        let mut given = INPUTS.map(|input| (input.name, self.inputs.has(input.name))).into_iter().chain(others);
        match given.find(|(flag, is_given)| *is_given && !used.contains(flag)) {
            Some((unused, _)) => Err(Failure::wrong(format!(
                "--{unused} has no effect on {}, which takes {}",
                hyphenated(query.name()),
                flags::text(&used)
            ))),
            None => Ok(()),
        }
    }

    /// The quantity with the given frame, task or point.
    fn subject<'q>(&self, query: Query<'static>, rows: &'q [usize], model: &Model) -> Result<Query<'q>> {
        let query = match query.declaration().of {
            Of::Task => query.of_task(Task { rows, ..Task::all(model.end_effector()?, self.task.coordinates()) }),
            _ => of_end_effector(query, model)?,
        };
        Ok(match &self.about {
            Some(text) => query.about(Vec3(array("--about", text, ["x", "y", "z"])?)),
            None => query,
        })
    }
}
