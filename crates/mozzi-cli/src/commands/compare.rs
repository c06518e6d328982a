//! `mozzi compare`: comparison with Pinocchio and MuJoCo on the same file, with explained differences.

use super::info;
use crate::failure::{Failure, Result};
use crate::json;
use crate::robot::PolicyArguments;
use crate::{input, robot_json};
use clap::Args;
use mozzi::Description;
use mozzi_compare::{Options, Source, ask, compare, find_python};
use std::path::Path;

#[derive(Args, Debug)]
pub struct CompareArguments {
    /// A robot's file (URDF, MJCF, or JSON of `mozzi convert`), or the name of an embedded robot
    model: String,
    /// Python interpreter with pin or mujoco installed [default: that of the active virtual environment, else python3]
    #[arg(long, value_name = "PATH")]
    python: Option<String>,
    /// Number of random states within the joints' limits
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=1000))]
    states: u16,
    /// Seed of the random states
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    policy: PolicyArguments,
}

pub fn run(arguments: &CompareArguments) -> Result<String> {
    if arguments.policy.frees() {
        return Err(Failure::wrong(
            "--floating is not for compare: other libraries read the file as it stands; free its base there, by a floating joint at \
             the root (URDF) or a freejoint (MJCF)",
        ));
    }
    let python = find_python(arguments.python.as_deref());
    let options = Options { python, states: arguments.states.into(), seed: arguments.seed };
    let (headline, comparison) = match arguments.policy.model(&arguments.model) {
        Ok(model) => {
            let comparison = compare(&model, source(&arguments.model, model.description())?, &options)?;
            (info::headline(&model) + "\n", comparison)
        }
        Err(refusal) => {
            let has_place = matches!(&refusal, Failure::Load(error) if !error.diagnostics().is_empty());
            if !has_place || arguments.model != "-" && !Path::new(&arguments.model).is_file() {
                return Err(refusal);
            }
            refusal.say();
            (String::new(), ask(source(&arguments.model, &Description::new("refused"))?, &options)?)
        }
    };
    let text = if arguments.json { json::print(&comparison.json()) } else { headline + &comparison.text() };
    if comparison.is_explained() { Ok(text) } else { Err(Failure::Answered(text)) }
}

/// What the libraries read: the file, or the text that a pipe held.
fn source(name: &str, robot: &Description) -> Result<Source> {
    if name != "-" {
        return Ok(Source::read(name, robot)?);
    }
    if robot_json::is_json(name) {
        return Ok(Source::written(input::name(name), robot)?);
    }
    let text = input::robot_text().map_err(|error| input::cannot(name, &error))?;
    Ok(Source::of_text(input::name(name), &String::from_utf8_lossy(text)))
}

impl From<mozzi_compare::Error> for Failure {
    fn from(error: mozzi_compare::Error) -> Self {
        let hint = if matches!(error, mozzi_compare::Error::Python { .. }) { " with --python" } else { "" };
        Failure::Wrong(format!("{error}{hint}"))
    }
}
