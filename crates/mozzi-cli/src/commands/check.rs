//! `mozzi check`: errors and warnings of a robot's file.

use super::{info, repairs};
use crate::failure::{self, Failure, Result};
use crate::report::mesh_root;
use crate::robot::PolicyArguments;
use crate::{input, json as pretty, robot_json, sarif};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_urdf::json::Misplaced;
use mozzi_urdf::{Consequence, Diagnostic, Severity, counted};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub struct CheckArguments {
    /// Robots' files (URDF, xacro, MJCF, SDFormat, or JSON of `mozzi convert`), or the names of embedded robots
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<String>,
    /// Text with excerpts on standard error, or on standard output one JSON object per diagnostic and line,
    /// or one log in SARIF 2.1.0
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Short for --format json
    #[arg(long, conflicts_with = "format")]
    json: bool,
    /// Propose repairs of a URDF's numbers, each with its reason and its effect on M: an inertia with a power of ten
    /// too much, of a wrong sign, with mixed columns, about the wrong point, in mm or g, or the nearest possible one;
    /// a mass counted twice; reversed limits; an effort of 0. Shapes are read from their files
    #[arg(long)]
    fix: bool,
    /// Propose inertias from the links' shapes, as their convex hulls filled with a density in kg/m³; a given mass is
    /// kept
    #[arg(long, value_name = "density=KG_PER_M3", conflicts_with = "fix")]
    estimate_inertia: Option<String>,
    /// Write the proposals into the files, and nothing else; - is written to standard output
    #[arg(long)]
    apply: bool,
    /// A folder above the meshes of the robot's file that lie outside of its own folder and package; those that are
    /// not found elsewhere are searched there
    #[arg(long, value_name = "FOLDER")]
    mesh_root: Option<PathBuf>,
    #[command(flatten)]
    policy: PolicyArguments,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
    Sarif,
}

impl CheckArguments {
    fn format(&self) -> Format {
        if self.json { Format::Json } else { self.format }
    }

    /// Whether proposals are applied.
    pub fn applies(&self) -> bool {
        self.apply
    }

    /// The folder of `--mesh-root`.
    pub fn mesh_root(&self) -> Result<Option<&Path>> {
        mesh_root(self.mesh_root.as_deref())
    }

    /// The density of `--estimate-inertia`.
    pub fn density(&self) -> Result<Option<f64>> {
        let Some(text) = &self.estimate_inertia else { return Ok(None) };
        let number = text.strip_prefix("density=").and_then(|number| number.parse::<f64>().ok());
        match number.filter(|density| *density > 0.0 && density.is_finite()) {
            Some(density) => Ok(Some(density)),
            None => Err(Failure::wrong(format!(
                "--estimate-inertia: is `{text}`, expected density= and a number above 0, kg/m³, such as density=1000"
            ))),
        }
    }
}

/// Checks each file; the command fails if one of them is refused.
pub fn run(arguments: &CheckArguments) -> Result<String> {
    let format = arguments.format();
    if arguments.fix || arguments.estimate_inertia.is_some() {
        if format == Format::Sarif {
            return Err(Failure::wrong("--fix: proposals are printed as text or JSON, expected --format text or json"));
        }
        return repairs::run(arguments, &arguments.models, format == Format::Json, &arguments.policy.settings());
    }
    if let (Format::Text, [name]) = (format, &arguments.models[..]) {
        return as_text(arguments, name);
    }
    let (mut all, mut refused) = (Vec::new(), 0);
    for name in &arguments.models {
        let is_refused = match format {
            Format::Text => as_text(arguments, name).map_err(|failure| failure.say()).is_err(),
            Format::Json | Format::Sarif => {
                let (found, is_refused) = as_objects(arguments, name)?;
                all.extend(found);
                is_refused
            }
        };
        refused += usize::from(is_refused);
    }
    let text = match format {
        Format::Text => String::new(),
        Format::Json | Format::Sarif => print(format, &all),
    };
    if format == Format::Text {
        let count = arguments.models.len();
        failure::write(&format!("{} of {count} robots are valid\n", count - refused));
    }
    if refused == 0 { Ok(text) } else { Err(Failure::Answered(text)) }
}

/// Prints the findings of one file.
fn as_text(arguments: &CheckArguments, name: &str) -> Result<String> {
    if robot_json::is_json(name) {
        return json_robot(arguments, name);
    }
    let loaded = arguments.policy.open(name)?;
    failure::say(&loaded.warnings);
    mozzi_urdf::unused(&loaded.unused).iter().for_each(|count| failure::note(count));
    let count = loaded.warnings.len();
    sound(input::name(name), count, &arguments.policy.constrained(name, loaded.description)?.build()?)
}

/// The findings of one file, and whether it is refused.
fn as_objects(arguments: &CheckArguments, name: &str) -> Result<(Vec<Value>, bool)> {
    if robot_json::is_json(name) {
        let place = input::name(name);
        let robot = match robot_json::read(name) {
            Err(errors) => return Ok((errors.iter().map(|error| misplaced(place, error)).collect(), true)),
            Ok(robot) => arguments.policy.constrained(name, arguments.policy.freed(robot))?,
        };
        let (errors, warnings) = arguments.policy.problems(&robot);
        let all = errors.iter().map(|e| ("error", e)).chain(warnings.iter().map(|w| ("warning", w)));
        let found = all.map(|(severity, p)| placeless(place, severity, Some(p.code), &p.to_string())).collect();
        return Ok((found, !errors.is_empty()));
    }
    Ok(match arguments.policy.open(name) {
        Ok(loaded) => (objects(loaded.warnings.iter().chain(&loaded.unused)), false),
        Err(error) if error.diagnostics().is_empty() => {
            (vec![placeless(name, "error", None, &error.to_string())], true)
        }
        Err(error) => (objects(error.diagnostics()), true),
    })
}

/// A robot from JSON: the same checks, each problem by its element, as there is no source text.
fn json_robot(arguments: &CheckArguments, name_or_path: &str) -> Result<String> {
    let name = input::name(name_or_path);
    let robot = arguments.policy.constrained(name_or_path, arguments.policy.freed(robot_json::read(name_or_path)?))?;
    let (errors, warnings) = arguments.policy.problems(&robot);
    let all = errors.iter().map(|e| ("error", e)).chain(warnings.iter().map(|w| ("warning", w)));
    all.for_each(|(severity, problem)| failure::write(&format!("{name}: {severity}: {problem}\n")));
    match errors.len() {
        0 => sound(name, warnings.len(), &robot.build()?),
        many => Err(Failure::wrong(format!("{name} is refused: {}", counted(many, "error")))),
    }
}

/// Reports that the robot is valid.
fn sound(name: &str, warnings: usize, model: &Model) -> Result<String> {
    let count = match warnings {
        0 => "no warnings".to_string(),
        many => counted(many, "warning"),
    };
    failure::write(&format!("{name} is valid, {count}: {}\n", info::headline(model)));
    Ok(String::new())
}

/// Diagnostics as JSON, each with its severity (error, warning, note) and its place.
fn objects<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>) -> Vec<Value> {
    let object = |found: &Diagnostic| {
        let severity = match found.severity() {
            _ if found.consequence() == Consequence::Unused => "note",
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let mut object = json!({
            "severity": severity,
            "code": found.code(),
            "message": found.message(),
            "file": found.file(),
            "line": found.line(),
            "column": found.column(),
            "help": found.help(),
        });
        // inside a xacro macro: the calls that lead there
        if !found.calls().is_empty() {
            object["calls"] = found.calls().trim_start_matches(", ").into();
        }
        object
    };
    diagnostics.into_iter().map(object).collect()
}

/// There is no source text.
fn placeless(name: &str, severity: &str, code: Option<&str>, message: &str) -> Value {
    json!({
        "severity": severity,
        "code": code.map(|code| format!("mozzi::urdf::{code}")),
        "message": message,
        "file": name,
        "line": null,
        "column": null,
        "help": code.and_then(mozzi_urdf::remedy),
    })
}

/// The JSON text itself is invalid.
fn misplaced(name: &str, error: &Misplaced) -> Value {
    let (row, column) = error.position.unzip();
    json!({
        "severity": "error", "code": null, "message": error.message,
        "file": name, "line": row, "column": column, "help": null,
    })
}

fn print(format: Format, diagnostics: &[Value]) -> String {
    match format {
        Format::Sarif => pretty::print(&sarif::log(diagnostics)),
        _ => diagnostics.iter().map(|object| format!("{object}\n")).collect(),
    }
}
