//! `mozzi check --fix` and `--estimate-inertia`: proposals for a URDF's numbers, printed, and applied on request.

use super::check::CheckArguments;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::output::{self, Output};
use crate::robot_json;
use mozzi_urdf::fix::{self, Proposal};
use mozzi_urdf::{EditError, Settings, counted};
use serde_json::json;
use std::io::Write;

/// The proposals for each file, as text or one JSON object per line; with `--apply` the files are rewritten, and
/// standard input is written to standard output.
pub fn run(arguments: &CheckArguments, models: &[String], is_json: bool, settings: &Settings) -> Result<String> {
    let (mut said, density, mesh_root) = (String::new(), arguments.density()?, arguments.mesh_root()?);
    for name in models {
        if robot_json::is_json(name) {
            let shown = input::name(name);
            return Err(Failure::wrong(format!("{shown} cannot be repaired: only URDF is repaired, and this is JSON")));
        }
        let text = input::robot_file(name)?;
        let found = match density {
            Some(density) => fix::estimates(name, &text, density, mesh_root, settings),
            None => fix::proposals(name, &text, mesh_root, settings),
        };
        let found = found.map_err(|error| match error {
            EditError::Load(error) => Failure::from(error),
            EditError::Unsupported(why) => {
                Failure::wrong(format!("{} cannot be repaired: {}", input::name(name), why.reasons.join("; ")))
            }
        })?;
        let (shown, proposals) = (input::name(name), &found.proposals);
        let mut lines: String = proposals.iter().map(|proposal| line(shown, proposal, is_json)).collect();
        for (code, note) in found.notes() {
            match is_json {
                true => lines += &format!("{}\n", json!({ "file": shown, "code": code, "note": note })),
                false => failure::note(&format!("{shown}: {note}")),
            }
        }
        let applied = match (arguments.applies(), proposals.is_empty()) {
            (_, true) => "",
            (true, false) => ", applied",
            (false, false) => "; --apply writes them",
        };
        let count = counted(proposals.len(), "proposal");
        if arguments.applies() && name == "-" {
            // standard output is the robot's
            failure::write(&lines);
            output::to_stdout(&fix::apply(&text, proposals))?;
        } else {
            said += &lines;
            if arguments.applies() && !proposals.is_empty() {
                let repaired = fix::apply(&text, proposals);
                Output::replacing(name)?.write(|file| file.write_all(repaired.as_bytes()))?;
            }
        }
        failure::write(&format!("{shown}: {count}{applied}\n"));
    }
    Ok(said)
}

fn line(name: &str, proposal: &Proposal, is_json: bool) -> String {
    if is_json { format!("{}\n", object(name, proposal)) } else { format!("{name}:{}: {proposal}\n", proposal.line) }
}

fn object(name: &str, proposal: &Proposal) -> serde_json::Value {
    json!({
        "file": name, "line": proposal.line, "code": proposal.code, "element": proposal.subject,
        "change": proposal.change, "reason": proposal.reason, "effect": proposal.effect,
    })
}
