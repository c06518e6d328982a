//! `mozzi terms`: every quantity of the dynamics at one state.

mod json;
mod stacked;
pub mod text;
pub mod values;

use crate::failure::{Failure, Result};
use crate::json::print;
use crate::quantity::quantity;
use crate::robot::{RobotArguments, screen};
use crate::state::{Motion, MotionArguments, environment};
use crate::task::TaskArguments;
use crate::text::Page;
use crate::workload;
use clap::Args;
use mozzi::quantities::{LIST, Of, Query};
use serde_json::Value;
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
    /// Show these quantities alone: M,g
    #[arg(long, value_name = "NAME,…", value_parser = quantity(), value_delimiter = ',', conflicts_with = "all")]
    only: Vec<Query<'static>>,
    /// Show all quantities, however many lines they take
    #[arg(long)]
    all: bool,
    /// Also print the state
    #[arg(short, long)]
    verbose: bool,
}

/// Velocities of a robot whose terms are computed: ten matrices take seconds.
const MOST: usize = 1000;

pub fn run(arguments: &TermsArguments) -> Result<String> {
    if arguments.stacked && !arguments.only.is_empty() && !arguments.robot.json {
        return Err(Failure::wrong("--stacked has no effect with --only: the text has these quantities alone"));
    }
    let model = arguments.robot.load_at(|model| Ok(arguments.motion.start(model)?.0))?;
    workload::at_most(MOST, &model, "for all terms; `mozzi compute` has one quantity")?;
    let Motion { state, applied } = arguments.motion.read(&model)?;
    let environment = environment(&model, &applied);
    let mut terms = Terms::at(&model, state, &environment)?;
    let is_of_task = |query: &Query| query.declaration().of == Of::Task;
    let is_shown = arguments.only.is_empty() || arguments.robot.json && arguments.only.iter().any(is_of_task);
    if is_shown || arguments.task.task.is_some() {
        terms.add_task(&arguments.task, &environment)?;
    }
    if arguments.stacked {
        terms.closed_form = Some(model.closed_form(&terms.theta, &terms.dtheta, &environment)?);
    }
    if arguments.robot.json {
        let mut object = json::object(&terms);
        if let (Value::Object(entries), false) = (&mut object, arguments.only.is_empty()) {
            let is_other = |name: &str| {
                LIST.iter().any(|of| of.name == name) && !arguments.only.iter().any(|query| query.name() == name)
            };
            entries.retain(|name, _| !is_other(name) && name != "newton_euler");
        }
        return Ok(print(&object));
    }
    if !arguments.only.is_empty() {
        let mut page = Page::default();
        for (k, &query) in arguments.only.iter().enumerate() {
            if k > 0 {
                page.blank();
            }
            terms.one(query, environment)?.write(&mut page, arguments.verbose);
        }
        return Ok(page.end());
    }
    terms.clean(&environment);
    let most = if arguments.all || arguments.stacked { usize::MAX } else { screen(&model) };
    Ok(text::page(&terms, arguments.verbose, most))
}
