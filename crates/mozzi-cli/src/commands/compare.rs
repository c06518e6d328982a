//! `mozzi compare`: what Pinocchio and MuJoCo compute of the same file, and why it differs.

use super::info;
use crate::compare::answer::{Answer, Robot, Silence};
use crate::compare::python::{self, Peer};
use crate::compare::question::{Question, Source};
use crate::compare::report_text::Finding;
use crate::compare::verdict::{Verdict, judge};
use crate::compare::{numbers, report_json, report_text, words};
use crate::failure::{Failure, Result};
use crate::json;
use crate::robot::PolicyArguments;
use crate::text::Page;
use clap::Args;
use mozzi::{Description, Model};
use mozzi_urdf::embedded;
use serde_json::{Value, json};
use std::path::Path;

#[derive(Args, Debug)]
pub struct CompareArguments {
    /// A robot's file (URDF, MJCF, or JSON of `mozzi convert`), or the name of an embedded robot
    model: String,
    /// The Python that has pin or mujoco [default: that of the active virtual environment, else python3]
    #[arg(long, value_name = "PATH")]
    python: Option<String>,
    /// Random states, within the joints' limits
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=1000))]
    states: u16,
    /// Of the random numbers
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
    let python = python::find(arguments.python.as_deref());
    let model = match arguments.policy.model(&arguments.model) {
        Ok(model) => model,
        Err(refusal) => return refused(arguments, &python, refusal),
    };
    let robot = model.description();
    let question = Question::new(source(&arguments.model, robot)?, robot, arguments.states.into(), arguments.seed)?;
    let is_mjcf = question.source.language == "mjcf";
    let mut peers = vec![Peer::Pinocchio, Peer::MuJoCo];
    if model.is_coupled() && !is_mjcf {
        peers.push(Peer::PinocchioMimic);
    }
    let answers = python::ask(&python, &question, &peers)?;
    somebody(&python, &answers)?;
    let verdict = |answer: &Answer, coupled: bool| -> Result<Option<Verdict>> {
        let judge = |from: &Robot| judge(robot, &question, answer, from, coupled);
        answer.robot.as_ref().ok().map(judge).transpose()
    };
    let mut findings = Vec::new();
    for (k, answer) in answers.iter().take(2).enumerate() {
        let coupled = match answers.get(2).filter(|_| k == 0) {
            Some(answer) => Some((answer, verdict(answer, true)?)),
            None => None,
        };
        findings.push(Finding { answer, verdict: verdict(answer, false)?, coupled });
    }
    let text = if arguments.json {
        object(arguments, Some(&model), &findings)
    } else {
        page(arguments, &model, &question, &findings)
    };
    let mut verdicts = findings.iter().filter_map(|finding| finding.verdict.as_ref()).peekable();
    let is_well = verdicts.peek().is_some() && verdicts.all(Verdict::is_explained);
    if is_well { Ok(text) } else { Err(Failure::Answered(text)) }
}

/// The file where the libraries can read it, a text where they cannot.
fn source(name_or_path: &str, robot: &Description) -> Result<Source> {
    let text = |text: String| Source { language: "urdf", path: None, text: Some(text) };
    if let Some(embedded) = embedded::text(name_or_path) {
        return Ok(text(embedded.to_string()));
    }
    let path = Path::new(name_or_path);
    if path.extension().is_some_and(|suffix| suffix == "json") {
        let written = mozzi_urdf::write(robot);
        return Ok(text(
            written
                .map_err(|why| Failure::wrong(format!("{name_or_path} cannot be given to other libraries: {why}")))?,
        ));
    }
    let bytes =
        std::fs::read(path).map_err(|error| Failure::wrong(format!("{name_or_path} cannot be read: {error}")))?;
    let is_mjcf = mozzi_urdf::mjcf::is_mjcf(&String::from_utf8_lossy(&bytes));
    let language = if is_mjcf { "mjcf" } else { "urdf" };
    Ok(Source { language, path: Some(name_or_path.to_string()), text: None })
}

fn somebody(python: &Path, answers: &[Answer]) -> Result<()> {
    let silent = |answer: &&Answer| matches!(answer.robot, Err(Silence::NotInstalled(_) | Silence::Died(_)));
    if !answers.iter().all(|answer| silent(&answer)) {
        return Ok(());
    }
    let reason = |answer: &Answer| match &answer.robot {
        Err(silence) => format!("{} {}", answer.library, words::silence(silence, answer.library)),
        Ok(_) => String::new(),
    };
    let reasons: Vec<String> = answers.iter().take(2).map(reason).collect();
    Err(Failure::wrong(format!(
        "`{}` has no library to compare with: {}; `pip install pin mujoco` gives it both",
        python.display(),
        reasons.join("; ")
    )))
}

/// What the libraries make of a file that mozzi refuses.
fn refused(arguments: &CompareArguments, python: &Path, refusal: Failure) -> Result<String> {
    let path = Path::new(&arguments.model);
    let has_place = matches!(&refusal, Failure::Load(error) if !error.diagnostics().is_empty());
    if !has_place || !path.is_file() {
        return Err(refusal);
    }
    refusal.say();
    let source = source(&arguments.model, &Description::new("refused"))?;
    let question = Question { source, names: Vec::new(), axes: Vec::new(), states: Vec::new(), floating: false };
    let answers = python::ask(python, &question, &[Peer::Pinocchio, Peer::MuJoCo])?;
    somebody(python, &answers)?;
    let findings: Vec<Finding> =
        answers.iter().map(|answer| Finding { answer, verdict: None, coupled: None }).collect();
    if arguments.json {
        return Err(Failure::Answered(object(arguments, None, &findings)));
    }
    let mut page = Page::default();
    page.line(format!("{}: mozzi refuses it, so nothing is compared", arguments.model));
    findings.iter().for_each(|finding| report_text::write(&mut page, &question, finding));
    Err(Failure::Answered(page.end()))
}

fn page(arguments: &CompareArguments, model: &Model, question: &Question, findings: &[Finding]) -> String {
    let mut page = Page::default();
    page.line(info::headline(model));
    page.line(format!(
        "random states of seed {}; errors over ε times the size of the terms: about 1 is rounding, above {:.0e} a difference",
        arguments.seed,
        numbers::BOUND
    ));
    findings.iter().for_each(|finding| report_text::write(&mut page, question, finding));
    page.end()
}

fn object(arguments: &CompareArguments, model: Option<&Model>, findings: &[Finding]) -> String {
    json::print(&json!({
        "model": arguments.model,
        "refused": model.is_none(),
        "joints": model.map(|model| model.joint_names().map(Value::from).collect::<Value>()),
        "states": arguments.states,
        "seed": arguments.seed,
        "unit_of_errors": "machine epsilon times the size of the terms",
        "bound": numbers::BOUND,
        "libraries": findings.iter().map(report_json::object).collect::<Value>(),
    }))
}
