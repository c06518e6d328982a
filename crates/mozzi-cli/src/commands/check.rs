//! `mozzi check`: is the file a robot, and what is odd about it?

use super::info;
use crate::failure::{Failure, Result, say};
use crate::json;
use clap::Args;
use mozzi_urdf::{Diagnostic, Severity};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct CheckArguments {
    /// A URDF file, or the name of an embedded robot
    model: String,
    /// Call warnings errors
    #[arg(long)]
    strict: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &CheckArguments) -> Result<String> {
    match mozzi_urdf::open(&arguments.model) {
        Ok(loaded) => {
            let warnings = loaded.warnings.clone();
            let fine = warnings.is_empty() || !arguments.strict;
            let model = loaded.build()?;
            if arguments.json {
                let text = json::print(&object(&arguments.model, fine, &warnings, None));
                return if fine { Ok(text) } else { Err(Failure::Answered(text)) };
            }
            warnings.iter().for_each(say);
            let count = match warnings.len() {
                0 => "no warnings".to_string(),
                1 => "1 warning".to_string(),
                many => format!("{many} warnings"),
            };
            let verdict = if fine { "is a robot that can be computed" } else { "is refused, as --strict asks" };
            let text = format!("{} {verdict}, {count}: {}\n", arguments.model, info::headline(&model));
            if fine { Ok(text) } else { Err(Failure::Answered(text)) }
        }
        Err(error) if arguments.json => {
            let headline = error.to_string().lines().next().unwrap_or_default().to_string();
            let report = object(&arguments.model, false, error.diagnostics(), Some(headline));
            Err(Failure::Answered(json::print(&report)))
        }
        Err(error) => Err(error.into()),
    }
}

fn object(model: &str, fine: bool, diagnostics: &[Diagnostic], error: Option<String>) -> Value {
    let diagnostic = |found: &Diagnostic| {
        json!({
            "severity": match found.severity() { Severity::Error => "error", Severity::Warning => "warning" },
            "code": found.code(),
            "file": found.file(),
            "line": found.line(),
            "column": found.column(),
            "message": found.message(),
            "help": found.help(),
        })
    };
    json!({
        "model": model,
        "ok": fine,
        "error": error,
        "diagnostics": diagnostics.iter().map(diagnostic).collect::<Value>(),
    })
}
