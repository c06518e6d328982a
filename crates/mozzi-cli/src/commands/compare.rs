//! `mozzi compare`: comparison with Pinocchio and MuJoCo on the same file, or with another file of the robot, with
//! explained differences.

use super::info;
use crate::failure::{Failure, Result};
use crate::json;
use crate::numbers::number;
use crate::robot::PolicyArguments;
use crate::{input, robot_json, workload};
use clap::Args;
use mozzi::Description;
use mozzi_report::compare::files::{RobotFile, compare_files};
use mozzi_report::compare::{Options, Source, ask, compare, find_python};
use mozzi_urdf::expanded;
use mozzi_urdf::geometry::geometry_with;
use mozzi_urdf::mjcf;
use std::path::Path;
use std::time::Duration;

#[derive(Args, Debug)]
pub struct CompareArguments {
    /// A robot's file (URDF, xacro, MJCF, SDFormat, or JSON of `mozzi convert`), or the name of an embedded robot
    model: String,
    /// Another file of the robot, such as a converter's: the two files are compared, without a simulator. The exit code
    /// is 0 only if moving joints, limits, couplings, named frames, starts and states are the same, and the forces
    /// agree to --tolerance
    other: Option<String>,
    /// With two files: the largest difference of M, forces, limits and places, as a part of each joint's largest number
    #[arg(long, value_name = "X", default_value = "1e-9", requires = "other")]
    tolerance: String,
    /// Python interpreter with pin or mujoco installed [default: that of the active virtual environment, else python3]
    #[arg(long, value_name = "PATH")]
    python: Option<String>,
    /// Number of random states within the joints' limits
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=1000))]
    states: u16,
    /// Seed of the random states
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Time limit for each library; a library that exceeds it is stopped and counts as one without a result
    #[arg(long, value_name = "SECONDS", default_value = "60")]
    time_limit: String,
    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    policy: PolicyArguments,
}

pub fn run(arguments: &CompareArguments) -> Result<String> {
    if let Some(other) = &arguments.other {
        return two_files(arguments, other);
    }
    let python = find_python(arguments.python.as_deref());
    let (states, seed) = (arguments.states.into(), arguments.seed);
    let options = Options { python, states, seed, time_limit: arguments.time_limit()? };
    let (headline, comparison) = match arguments.policy.model(&arguments.model) {
        Ok(model) => {
            workload::at_most(MOST, &model, "of one that is compared")?;
            let comparison = compare(&model, arguments.source(model.description())?, &options)?;
            (info::headline(&model) + "\n", comparison)
        }
        Err(refusal) => {
            let has_place = matches!(&refusal, Failure::Load(error) if !error.diagnostics().is_empty());
            if !has_place || arguments.model != "-" && !Path::new(&arguments.model).is_file() {
                return Err(refusal);
            }
            refusal.say();
            (String::new(), ask(source(arguments, &Description::new("refused"))?, &options)?)
        }
    };
    let text = if arguments.json { json::print(&comparison.json()) } else { headline + &comparison.text() };
    if comparison.is_explained() { Ok(text) } else { Err(Failure::Answered(text)) }
}

/// Velocities of a robot that is compared: M at each state takes memory.
const MOST: usize = 2000;

/// Two files, which mozzi reads both.
fn two_files(arguments: &CompareArguments, other: &str) -> Result<String> {
    let tolerance = number("--tolerance", &arguments.tolerance)?;
    if !(0.0..1.0).contains(&tolerance) {
        return Err(Failure::wrong(format!("--tolerance is {tolerance}, expected a number from 0 to 1")));
    }
    // as short as the two differ
    let short = |name: &str| Path::new(input::name(name)).file_name().map(|name| name.to_string_lossy().into_owned());
    let is_short = short(&arguments.model) != short(other);
    let file = |name: &str| -> Result<RobotFile> {
        let (model, inertial_axes) = arguments.policy.model_and_axes(name)?;
        workload::at_most(MOST, &model, "of one that is compared")?;
        let text = input::robot_file(name).unwrap_or_default(); // none of an embedded robot, a URDF
        let (is_json, is_sdf) = (robot_json::is_json(name), mozzi_urdf::sdf::is_sdf(&text));
        let is_mjcf = mjcf::is_mjcf(&text);
        let (has_start, has_rates) = (is_json || is_sdf || is_mjcf, !is_mjcf);
        // those of other formats are not read
        let has_shapes = name != "-" && !is_json && !is_sdf;
        let shapes = has_shapes.then(|| geometry_with(name, &arguments.policy.settings().xacro).ok());
        let shapes = shapes.flatten().map(|all| all.shapes);
        let shown = short(name).filter(|_| is_short).unwrap_or_else(|| input::name(name).to_string());
        let path = (name != "-").then(|| Path::new(name).to_path_buf());
        let xacro = &arguments.policy.settings().xacro;
        let actuation = match name {
            _ if !is_mjcf => None,
            "-" => Some(mjcf::actuation_of(None, input::name(name), text.as_bytes(), xacro)),
            name => Some(mjcf::actuation(name, xacro)?),
        };
        Ok(RobotFile { name: shown, model, inertial_axes, shapes, has_start, has_rates, actuation, path })
    };
    let comparison =
        compare_files(&file(&arguments.model)?, &file(other)?, arguments.states.into(), arguments.seed, tolerance)?;
    let text = if arguments.json { json::print(&comparison.json()) } else { comparison.text() };
    if comparison.agrees() { Ok(text) } else { Err(Failure::Answered(text)) }
}

impl CompareArguments {
    fn time_limit(&self) -> Result<Duration> {
        let seconds = number("--time-limit", &self.time_limit)?;
        if !(seconds > 0.0 && seconds <= 1e6) {
            return Err(Failure::wrong(format!("--time-limit is {seconds} s, expected more than 0 and at most 1e6 s")));
        }
        Ok(Duration::from_secs_f64(seconds))
    }

    /// The file as it is; with --floating, the robot written as URDF.
    fn source(&self, robot: &Description) -> Result<Source> {
        if self.policy.frees() {
            return Ok(Source::written(input::name(&self.model), robot)?);
        }
        source(self, robot)
    }
}

/// The input of the libraries: the file, or the text from a pipe.
fn source(arguments: &CompareArguments, robot: &Description) -> Result<Source> {
    let name = arguments.model.as_str();
    if name != "-" {
        // other libraries cannot read xacro
        let text = Path::new(name).is_file().then(|| std::fs::read(name)).and_then(|text| text.ok());
        let text = text.filter(|_| !robot_json::is_json(name));
        return match text.map(|text| expanded(name, text, arguments.policy.settings())).transpose()?.flatten() {
            Some(text) => Ok(Source::of_text(name, &text)),
            None => Ok(Source::read(name, robot)?),
        };
    }
    if robot_json::is_json(name) {
        return Ok(Source::written(input::name(name), robot)?);
    }
    let text = input::robot_text().map_err(|error| input::cannot(name, &error))?;
    if mozzi_urdf::sdf::is_sdf(&String::from_utf8_lossy(text)) {
        return Ok(Source::written(input::name(name), robot)?);
    }
    let expansion = expanded(input::name(name), text, arguments.policy.settings())?;
    Ok(Source::of_text(input::name(name), &expansion.unwrap_or_else(|| String::from_utf8_lossy(text).into_owned())))
}

impl From<mozzi_report::compare::Error> for Failure {
    fn from(error: mozzi_report::compare::Error) -> Self {
        let hint = match error {
            mozzi_report::compare::Error::Python { .. } => " with --python",
            mozzi_report::compare::Error::NoLibrary { .. } => "; --python names another Python",
            _ => "",
        };
        Failure::Wrong(format!("{error}{hint}"))
    }
}
