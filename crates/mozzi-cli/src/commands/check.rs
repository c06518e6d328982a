//! `mozzi check`: errors and warnings of a robot's file.

use super::info;
use crate::failure::{self, Failure, Result};
use crate::robot::PolicyArguments;
use crate::{input, json as pretty, robot_json, sarif};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_urdf::json::Misplaced;
use mozzi_urdf::{Consequence, Diagnostic, Severity};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct CheckArguments {
    /// A robot's file (URDF, xacro, MJCF, or JSON of `mozzi convert`), or the name of an embedded robot
    model: String,
    /// Text with excerpts on standard error, or on standard output one JSON object per diagnostic and line,
    /// or one log in SARIF 2.1.0
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// The same as --format json
    #[arg(long, conflicts_with = "format")]
    json: bool,
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
}

pub fn run(arguments: &CheckArguments) -> Result<String> {
    let name = arguments.model.as_str();
    if robot_json::is_json(name) {
        return json_robot(arguments);
    }
    let answer = arguments.policy.open(name);
    let format = arguments.format();
    if format != Format::Text {
        return match answer {
            Ok(loaded) => Ok(print(format, &objects(loaded.warnings.iter().chain(&loaded.unused)))),
            Err(error) if error.diagnostics().is_empty() => {
                Err(Failure::Answered(print(format, &[placeless(name, "error", None, &error.to_string())])))
            }
            Err(error) => Err(Failure::Answered(print(format, &objects(error.diagnostics())))),
        };
    }
    let loaded = answer?;
    loaded.warnings.iter().for_each(failure::say);
    mozzi_urdf::unused(&loaded.unused).iter().for_each(|count| failure::note(count));
    let count = loaded.warnings.len();
    sound(input::name(name), count, &arguments.policy.constrained(name, loaded.description)?.build()?)
}

/// A robot from JSON: the same checks, each problem by its element, as there is no source text.
fn json_robot(arguments: &CheckArguments) -> Result<String> {
    let name = input::name(&arguments.model);
    let (format, is_object) = (arguments.format(), arguments.format() != Format::Text);
    let robot = match robot_json::read(&arguments.model) {
        Err(errors) if is_object => {
            let errors: Vec<Value> = errors.iter().map(|error| misplaced(name, error)).collect();
            return Err(Failure::Answered(print(format, &errors)));
        }
        other => arguments.policy.constrained(&arguments.model, arguments.policy.freed(other?))?,
    };
    let (errors, warnings) = arguments.policy.problems(&robot);
    let all = || errors.iter().map(|e| ("error", e)).chain(warnings.iter().map(|w| ("warning", w)));
    if is_object {
        let found: Vec<Value> =
            all().map(|(severity, p)| placeless(name, severity, Some(p.code), &p.to_string())).collect();
        let text = print(format, &found);
        return if errors.is_empty() { Ok(text) } else { Err(Failure::Answered(text)) };
    }
    all().for_each(|(severity, problem)| failure::write(&format!("{name}: {severity}: {problem}\n")));
    match errors.len() {
        0 => sound(name, warnings.len(), &robot.build()?),
        1 => Err(Failure::wrong(format!("{name} is refused: 1 error"))),
        many => Err(Failure::wrong(format!("{name} is refused: {many} errors"))),
    }
}

/// Reports that the robot is valid.
fn sound(name: &str, warnings: usize, model: &Model) -> Result<String> {
    let count = match warnings {
        0 => "no warnings".to_string(),
        1 => "1 warning".to_string(),
        many => format!("{many} warnings"),
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
