//! `mozzi compute`: any quantity, at one state or at every state of a table.

mod flags;
mod gpu;
mod list;
pub mod noise;
pub mod one_state;
mod subject;
mod table;

use super::assemble::{check_constraints, violation};
use crate::angles;
use crate::failure::{self, Failure, Result};
use crate::inputs::{InputArguments, STATE};
use crate::json;
use crate::numbers::array;
use crate::quantity::{hyphenated, of_end_effector, quantity};
use crate::robot::{RobotArguments, screen};
use crate::state::WrenchArguments;
use crate::task::TaskArguments;
use crate::text::{Page, about, cut};
use crate::workload;
use clap::{Arg, Args};
use mozzi::quantities::{Dim, INPUTS, LIST, Of, Query};
use mozzi::{Environment, Model, Task, Vec3};
use mozzi_urdf::counted;
use one_state::OneState;
use serde_json::{Value, json};
use table::{Job, TableArguments};

#[derive(Args, Debug)]
pub struct ComputeArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// The quantity to compute, or several: M,h,g
    #[arg(index = 2, value_parser = quantity(), required_unless_present = "list", value_delimiter = ',', num_args = 1..)]
    quantity: Vec<Query<'static>>,
    /// List all quantities: names, formulas, inputs, outputs
    #[arg(long)]
    list: bool,
    /// The vector-Jacobian product of the quantity: the gradient of xᵀ or wᵀ times it, with the vector in --x or --w
    #[arg(long)]
    vjp: bool,
    /// Also print the state, gravity and the names of rows and columns
    #[arg(short, long)]
    verbose: bool,
    /// Print results of any length
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    inputs: InputArguments,
    #[command(flatten)]
    task: TaskArguments,
    /// Reference point of the momentum in {s}, m [default: the origin]
    #[arg(long, value_name = "X,Y,Z")]
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
    if arguments.list {
        return Ok(list::page());
    }
    let vjp = |query: &Query<'static>| if arguments.vjp { vjp_of(*query) } else { Ok(*query) };
    let queries = arguments.quantity.iter().map(vjp).collect::<Result<Vec<_>>>()?;
    arguments.check_flags(&queries)?;
    let model = arguments.robot.load_at(|model| Ok(arguments.inputs.start(model)?.0))?;
    let squares = |query: &Query| query.declaration().outputs.iter().any(|out| out.dims.starts_with(&[Dim::N, Dim::N]));
    if queries.iter().any(squares) {
        workload::matrices(&model)?;
    }
    let rows = arguments.task.rows()?;
    let queries =
        queries.into_iter().map(|query| arguments.subject(query, &rows, &model)).collect::<Result<Vec<_>>>()?;
    let applied = arguments.wrenches.read(&model)?;
    let environment = Environment { applied: &applied, ..model.environment() };
    check_constraints(queries.iter().copied(), &model)?;
    queries.iter().for_each(|&query| note_constraints(query, &model));
    if let Some(file) = &arguments.table.input {
        let (model, table, robot, &[query]) = (&model, &arguments.table, &arguments.robot, &queries[..]) else {
            return Err(Failure::wrong(format!(
                "--in: {} quantities are given, expected one: a table has the results of one",
                queries.len()
            )));
        };
        angles::of_file(file);
        return Job { file, query, model, environment, table, robot }.run();
    }
    let mut found = Vec::new();
    for query in queries {
        let inputs = arguments.inputs.read(query.declaration(), &model)?;
        let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        if query.declaration().is_constrained {
            let open = violation(&model, slices[0])?;
            if open > 1e-6 && open.is_finite() {
                failure::note(&format!("θ violates the constraints by {}; `mozzi assemble` closes them", about(open)));
            }
        }
        let outputs = model.compute(query, &slices, &environment)?;
        if outputs.iter().flatten().any(|x| !x.is_finite()) {
            let why = match query.declaration().is_constrained {
                true => "a constraint is undefined at θ, or the numbers are too large",
                false => "the numbers are too large; entries overflow",
            };
            failure::note(&format!("{}: {why}", hyphenated(query.name())));
        } else if query.name().starts_with("constrained_forward_dynamics") {
            let redundant = model.constraint_rank(slices[0])?.redundant;
            if let [one, others @ ..] = &redundant[..] {
                let rows = match others.len() {
                    0 => format!("`{one}` depends"),
                    more => format!("`{one}` and {} depend", counted(more, "other row")),
                };
                failure::note(&format!("λ is not unique: {rows} on the rest, along which it may be rounding"));
            }
        }
        found.push(OneState { query, model: &model, inputs, environment, outputs });
    }
    if arguments.robot.json {
        let mut objects: Vec<Value> = found.iter().map(OneState::object).collect();
        return Ok(json::print(&match objects.len() {
            1 => objects.remove(0),
            _ => json!({ "results": objects }),
        }));
    }
    let mut page = Page::default();
    for (k, one) in found.iter().enumerate() {
        if k > 0 {
            page.blank();
        }
        one.write(&mut page, arguments.verbose);
    }
    if !arguments.inputs.has_state() && found.iter().any(OneState::is_of_state) && !arguments.verbose {
        page.line("at the robot's start, as no --theta is given; -v prints it");
    }
    let lines: Vec<String> = page.end().lines().map(str::to_string).collect();
    let most = if arguments.all { usize::MAX } else { screen(&model) };
    Ok(cut(lines, most).into_iter().map(|line| line + "\n").collect())
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

/// Prints a note if the robot's constraints are left out.
fn note_constraints(query: Query, model: &Model) {
    let of_tree = ["forward_dynamics", "inverse_dynamics", "bias_forces", "gravity_forces", "task_space_dynamics"];
    if model.constraint_rows() > 0 && of_tree.iter().any(|name| query.name().starts_with(name)) {
        failure::note(
            "the robot's constraints do not act in this quantity; `constrained-forward-dynamics` applies them",
        );
    }
}

impl ComputeArguments {
    /// Checks that every given flag has an effect.
    fn check_flags(&self, queries: &[Query]) -> Result<()> {
        let mut used: Vec<&str> = Vec::new();
        for flag in queries.iter().flat_map(|query| flags::of(query.declaration())) {
            if !used.contains(&flag) {
                used.push(flag);
            }
        }
        let names: Vec<String> = queries.iter().map(|query| hyphenated(query.name())).collect();
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
                names.join(", "),
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
