//! `mozzi check --fix` and `--estimate-inertia`: proposals for a URDF's numbers, printed, and applied on request.

use super::check::CheckArguments;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::output::Output;
use mozzi_urdf::fix::{self, Proposal};
use mozzi_urdf::{EditError, Settings};
use serde_json::json;
use std::io::Write;

/// The proposals for each file, as text or one JSON object per line; with `--apply` the files are rewritten.
pub fn run(arguments: &CheckArguments, models: &[String], is_json: bool, settings: &Settings) -> Result<String> {
    let (mut said, density) = (String::new(), arguments.density()?);
    for name in models {
        let text = input::robot_file(name)?;
        let found = match density {
            Some(density) => fix::estimates(name, &text, density, settings),
            None => fix::proposals(name, &text, settings),
        };
        let found = found.map_err(|error| match error {
            EditError::Load(error) => Failure::from(error),
            other => Failure::wrong(format!("{}: {other}", input::name(name))),
        })?;
        let place = |proposal: &Proposal| format!("{}:{}", input::name(name), proposal.line);
        for proposal in &found {
            said += &match is_json {
                true => format!("{}\n", object(name, proposal)),
                false => format!("{}: {proposal}\n", place(proposal)),
            };
        }
        let count = match found.len() {
            1 => "1 proposal".to_string(),
            count => format!("{count} proposals"),
        };
        let shown = input::name(name);
        if !arguments.applies() || found.is_empty() {
            failure::write(&format!(
                "{shown}: {count}{}\n",
                if found.is_empty() { "" } else { "; --apply writes them" }
            ));
            continue;
        }
        let repaired = fix::apply(&text, &found);
        if name == "-" {
            said = repaired;
        } else {
            Output::replacing(name)?.write(|file| file.write_all(repaired.as_bytes()))?;
        }
        failure::write(&format!("{shown}: {count}, applied\n"));
    }
    Ok(said)
}

fn object(name: &str, proposal: &Proposal) -> serde_json::Value {
    json!({
        "file": input::name(name), "line": proposal.line, "code": proposal.code, "element": proposal.subject,
        "change": proposal.change, "reason": proposal.reason, "effect": proposal.effect,
    })
}
