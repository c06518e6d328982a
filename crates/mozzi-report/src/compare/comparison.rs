//! Runs the libraries, compares, and collects the results.

use crate::compare::answer::{Answer, Robot, Unavailable};
use crate::compare::python::{self, Peer};
use crate::compare::question::Question;
use crate::compare::report_text::Finding;
use crate::compare::verdict::{Verdict, judge};
use crate::compare::{BOUND, Error, Result, Source, report_json, report_text, vocabulary};
use crate::text::Page;
use mozzi::Model;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Importing a library takes seconds, computing a robot's states a fraction of a second.
pub const TIME_LIMIT: Duration = Duration::from_secs(60);

/// How a robot is compared.
#[derive(Clone, Debug)]
pub struct Options {
    /// The Python interpreter with pin or mujoco; by default that of the active virtual environment, else `python3`.
    pub python: PathBuf,
    /// Number of random states within the joints' limits; 10 by default.
    pub states: usize,
    /// Seed of the random states; 1 by default.
    pub seed: u64,
    /// Time limit after which a library's process is killed; [`TIME_LIMIT`] by default.
    pub time_limit: Duration,
}

impl Default for Options {
    fn default() -> Self {
        Options { python: python::find(None), states: 10, seed: 1, time_limit: TIME_LIMIT }
    }
}

/// The result of comparing a robot with the libraries.
#[derive(Debug)]
pub struct Comparison {
    question: Question,
    seed: u64,
    /// None if mozzi refuses the robot.
    joints: Option<Vec<String>>,
    findings: Vec<Finding>,
}

/// Compares a robot with Pinocchio and MuJoCo on the same source.
///
/// # Errors
/// See [`Error`].
pub fn compare(model: &Model, source: Source, options: &Options) -> Result<Comparison> {
    let robot = model.description();
    let question = Question::new(source, robot, options.states, options.seed)?;
    let mut peers = vec![Peer::Pinocchio, Peer::MuJoCo];
    if model.has_mimic_joints() && question.source.language != "mjcf" {
        peers.push(Peer::PinocchioMimic);
    }
    let mut answers = python::ask(&options.python, &question, &peers, options.time_limit)?;
    let coupled = answers.drain(2..).next();
    somebody(&options.python, &answers)?;
    let verdict = |answer: &Answer, coupled: bool| -> Result<Option<Verdict>> {
        let judge = |from: &Robot| judge(robot, &question, answer, from, coupled);
        answer.robot.as_ref().ok().map(judge).transpose()
    };
    let mut coupled = match coupled {
        Some(answer) => Some((verdict(&answer, true)?, answer)),
        None => None,
    };
    let findings = answers.into_iter().map(|answer| {
        let coupled = coupled.take().map(|(verdict, answer)| (answer, verdict)); // Pinocchio, the first
        Ok(Finding { verdict: verdict(&answer, false)?, answer, coupled })
    });
    let findings = findings.collect::<Result<_>>()?;
    let joints = Some(model.joint_names().map(str::to_string).collect());
    Ok(Comparison { seed: options.seed, joints, findings, question })
}

/// Reports whether the libraries load a file that mozzi refuses.
///
/// # Errors
/// See [`Error`].
pub fn ask(source: Source, options: &Options) -> Result<Comparison> {
    let question = Question::of_file(source);
    let answers = python::ask(&options.python, &question, &[Peer::Pinocchio, Peer::MuJoCo], options.time_limit)?;
    somebody(&options.python, &answers)?;
    let findings = answers.into_iter().map(|answer| Finding { answer, verdict: None, coupled: None }).collect();
    Ok(Comparison { question, seed: options.seed, joints: None, findings })
}

fn somebody(python: &Path, answers: &[Answer]) -> Result<()> {
    let silent = |answer: &Answer| matches!(answer.robot, Err(Unavailable::NotInstalled(_) | Unavailable::Died(..)));
    if !answers.iter().all(silent) {
        return Ok(());
    }
    let (mut libraries, mut messages, mut reasons) = (Vec::new(), Vec::new(), Vec::new());
    for answer in answers {
        match &answer.robot {
            Err(Unavailable::NotInstalled(message)) => {
                libraries.push(answer.library);
                messages.push(message.as_str());
            }
            Err(unavailable) => {
                reasons.push(format!("{} {}", answer.library, vocabulary::unavailable(unavailable, answer.library)));
            }
            Ok(_) => {}
        }
    }
    // each once: NumPy may be missing for both
    libraries.dedup();
    messages.dedup();
    if !libraries.is_empty() {
        let (verb, both) = if libraries.len() == 1 { ("is", "") } else { ("are", " installs both") };
        let (libraries, messages) = (libraries.join(" and "), messages.join(", "));
        reasons.push(format!("{libraries} {verb} not installed ({messages}); `pip install pin mujoco`{both}"));
    }
    let reasons = reasons.join("; ");
    Err(Error::NoLibrary { python: python.to_path_buf(), reasons })
}

impl Comparison {
    fn verdicts_are(&self, fine: fn(&Verdict) -> bool) -> bool {
        let mut verdicts = self.findings.iter().filter_map(|finding| finding.verdict.as_ref()).peekable();
        verdicts.peek().is_some() && verdicts.all(fine)
    }

    /// Whether at least one library computed results, and all of them agree.
    pub fn agrees(&self) -> bool {
        self.verdicts_are(Verdict::agrees)
    }

    /// True if at least one library computed results, every difference is explained, and no installed library failed to
    /// return a result.
    pub fn is_explained(&self) -> bool {
        let answers = self.findings.iter().flat_map(|finding| {
            [Some(&finding.answer), finding.coupled.as_ref().map(|(answer, _)| answer)].into_iter().flatten()
        });
        let mut died = answers.filter(|answer| matches!(answer.robot, Err(Unavailable::Died(..))));
        self.verdicts_are(Verdict::is_explained) && died.next().is_none()
    }

    /// The report as text: for each library whether it agrees, and the causes.
    pub fn text(&self) -> String {
        let mut page = Page::default();
        match &self.joints {
            Some(_) => page.line(format!(
                "random states of seed {}; errors over ε times the size of the terms: about 1 is rounding, above {BOUND:.0e} a difference",
                self.seed
            )),
            None => page.line(format!("{}: mozzi refuses it, so nothing is compared", self.question.source.name)),
        };
        self.findings.iter().for_each(|finding| report_text::write(&mut page, &self.question, finding));
        page.end()
    }

    /// The report as JSON.
    pub fn json(&self) -> Value {
        json!({
            "model": self.question.source.name,
            "refused": self.joints.is_none(),
            "joints": self.joints,
            "states": self.question.states.len(),
            "seed": self.seed,
            "unit_of_errors": "machine epsilon times the size of the terms",
            "bound": BOUND,
            "libraries": self.findings.iter().map(report_json::object).collect::<Value>(),
        })
    }
}
