//! The comparison's report as text.

use crate::compare::answer::{Answer, Robot};
use crate::compare::numbers::{Entry, Errors, QUANTITIES};
use crate::compare::question::Question;
use crate::compare::verdict::Verdict;
use crate::compare::vocabulary;
use crate::text::{Page, about, table};

/// The result for one library.
#[derive(Debug)]
pub struct Finding {
    pub answer: Answer,
    pub verdict: Option<Verdict>,
    /// Pinocchio's results with coupled mimic joints, if it was called that way.
    pub coupled: Option<(Answer, Option<Verdict>)>,
}

pub fn write(page: &mut Page, question: &Question, finding: &Finding) {
    let answer = &finding.answer;
    let name = title(answer);
    match (&answer.robot, &finding.verdict) {
        (Ok(robot), Some(verdict)) => {
            let answered = if verdict.agrees() {
                "agrees"
            } else if verdict.is_explained() {
                "differs, explained"
            } else {
                "differs, not explained"
            };
            page.blank().line(format!("{name}: {answered}"));
            numbers(page, verdict, question);
            verdict.causes.iter().for_each(|found| {
                page.line(format!("  - {}", vocabulary::cause(&found.cause, answer)));
                // a single cause is printed in the first row of the table
                if verdict.after.agree() && verdict.causes.len() > 1 {
                    page.line(format!("    all but this: {}", errors(found.without)));
                }
            });
            extra(page, verdict, answer);
            if let Some(entry) = &verdict.first {
                first(page, entry, answer.library);
            }
            notes(page, question, robot, finding, verdict);
        }
        (Err(unavailable), _) => {
            page.blank().line(format!("{name}: {}", vocabulary::unavailable(unavailable, answer.library)));
        }
        // a robot that mozzi refuses
        (Ok(robot), None) => {
            page.blank().line(format!("{name}: loads the file: {} velocities", robot.side.names.len()));
        }
    }
    let verb = if answer.robot.is_ok() { "taken" } else { "tried" };
    for (message, workaround) in &answer.attempts {
        page.line(format!(
            "  it refuses the file as it stands: {message}; {verb} {}",
            vocabulary::workaround(*workaround)
        ));
    }
}

pub fn title(answer: &Answer) -> String {
    format!("{} {}", answer.library, answer.version.as_deref().unwrap_or("")).trim_end().to_string()
}

fn errors(errors: Errors) -> String {
    QUANTITIES.iter().zip(errors.0).map(|(name, x)| format!("{name} {}", about(x))).collect::<Vec<_>>().join(", ")
}

fn numbers(page: &mut Page, verdict: &Verdict, question: &Question) {
    let row = |name: &str, errors: Errors| {
        std::iter::once(name.to_string()).chain(errors.0.iter().map(|&x| about(x))).collect::<Vec<_>>()
    };
    let count = question.states.len();
    let title = format!("largest error of {count} state{}, ε", if count == 1 { "" } else { "s" });
    let mut rows: Vec<Vec<String>> = vec![std::iter::once(title).chain(QUANTITIES.map(str::to_string)).collect()];
    rows.push(row("as both read the file", verdict.before));
    if !verdict.causes.is_empty() {
        rows.push(row("all below accounted for", verdict.after));
    }
    page.lines(&table(&rows, "lr"));
}

fn extra(page: &mut Page, verdict: &Verdict, answer: &Answer) {
    for (name, nv) in &verdict.extra {
        let what = match nv {
            6 => "a floating base there",
            1 => "a moving joint there",
            _ => "a joint with several velocities there",
        };
        page.line(format!("  - `{name}` of {} is {what} and fixed here; compared at rest", answer.library));
    }
}

fn first(page: &mut Page, entry: &Entry, library: &str) {
    let place = entry.joints.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let Entry { quantity, state, mozzi, theirs, .. } = entry;
    page.line(format!(
        "  first entry that still differs: {quantity}[{place}] is {mozzi} here, {theirs} in {library} (state {})",
        state + 1
    ));
}

fn notes(page: &mut Page, question: &Question, robot: &Robot, finding: &Finding, verdict: &Verdict) {
    let library = finding.answer.library;
    if let Some(order) = &verdict.order {
        let (k, &j) = order.iter().enumerate().find(|(k, j)| k != *j).unwrap_or((0, &0));
        let why = if library == "Pinocchio" { ", which sorts siblings by name" } else { "" };
        page.line(format!(
            "  order of joints: different in {library}{why}: its joint {} is `{}`, here `{}`",
            k + 1,
            question.names[j],
            question.names[k]
        ));
    }
    let joints = &robot.constants.joints;
    let circles: Vec<&str> = joints.iter().filter(|j| j.nv == 1 && j.nq == 2).map(|j| j.name.as_str()).collect();
    if !circles.is_empty() {
        let names = vocabulary::some(&circles, |name| format!("`{name}`"));
        page.line(format!("  positions: {library} takes (cos θ, sin θ) of joints without limits: {names}"));
    }
    if joints.iter().any(|joint| joint.nv > 1) {
        page.line(format!("  coordinates: {}", vocabulary::coordinates(library)));
    }
    let renamed: Vec<_> = joints.iter().filter(|joint| joint.name != joint.called).collect();
    if !renamed.is_empty() {
        let names = vocabulary::some(&renamed, |joint| format!("`{}` is `{}`", joint.name, joint.called));
        page.line(format!("  names: known by their axes, here and in {library}: {names}"));
    }
    match &finding.coupled {
        Some((_, Some(verdict))) if verdict.agrees() => {
            let worst = about(verdict.before.worst());
            page.line(format!("  tried: with mimic=True {library} agrees, worst error {worst} ε"));
        }
        Some((_, Some(verdict))) if verdict.is_explained() => {
            let worst = about(verdict.after.worst());
            page.line(format!(
                "  tried: with mimic=True the mimic joints follow; the rest explained as above, worst error {worst} ε"
            ));
        }
        Some((_, Some(verdict))) => {
            page.line(format!("  tried: with mimic=True it still differs: {}", errors(verdict.before)));
        }
        Some((answer, None)) => {
            if let Err(unavailable) = &answer.robot {
                page.line(format!("  tried: with mimic=True it {}", vocabulary::unavailable(unavailable, library)));
            }
        }
        None => {}
    }
}
