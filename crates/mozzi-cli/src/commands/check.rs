//! `mozzi check`: is the file a robot, and what is odd about it?

use super::info;
use crate::failure::{self, Failure, Result};
use crate::robot::PolicyArguments;
use clap::{Args, ValueEnum};
use mozzi_urdf::{Diagnostic, LoadError, Severity};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct CheckArguments {
    /// A robot's file, or the name of an embedded robot
    model: String,
    /// Text with excerpts on standard error, or one JSON object a line on standard output for each diagnostic
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
}

pub fn run(arguments: &CheckArguments) -> Result<String> {
    let name = &arguments.model;
    let answer = arguments.policy.open(name);
    if arguments.json || arguments.format == Format::Json {
        return match answer {
            Ok(loaded) => Ok(lines(&loaded.warnings)),
            Err(error) if error.diagnostics().is_empty() => Err(Failure::Answered(no_place(name, &error))),
            Err(error) => Err(Failure::Answered(lines(error.diagnostics()))),
        };
    }
    let loaded = answer?;
    loaded.warnings.iter().for_each(failure::say);
    let count = match loaded.warnings.len() {
        0 => "no warnings".to_string(),
        1 => "1 warning".to_string(),
        many => format!("{many} warnings"),
    };
    let model = loaded.build()?;
    failure::write(&format!("{name} is a robot that can be computed, {count}: {}\n", info::headline(&model)));
    Ok(String::new())
}

fn lines(diagnostics: &[Diagnostic]) -> String {
    let line = |found: &Diagnostic| {
        let severity = match found.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        line(json!({
            "severity": severity,
            "code": found.code(),
            "message": found.message(),
            "file": found.file(),
            "line": found.line(),
            "column": found.column(),
            "help": found.help(),
        }))
    };
    diagnostics.iter().map(line).collect()
}

/// There is no file to point at.
fn no_place(name: &str, error: &LoadError) -> String {
    line(json!({
        "severity": "error",
        "code": null,
        "message": error.to_string(),
        "file": name,
        "line": null,
        "column": null,
        "help": null,
    }))
}

fn line(object: Value) -> String {
    format!("{object}\n")
}
