//! Findings of the library's own checks of a description, at their places in the text.

use crate::report::finding::Finding;
use crate::report::places::Places;
use crate::report::spelling::did_you_mean;
use mozzi::Description;
use mozzi::model::{Element, Problem};

/// Suggestions are searched for at most this many names, in robots with at most this many links and joints.
const MOST_SUGGESTIONS: usize = 20;
const MOST_NAMES: usize = 2000;

/// The findings of [`Description::check`], without repetitions of earlier reports.
pub(crate) fn findings(description: &Description, places: &Places) -> Vec<Finding> {
    let is_cut = places.tree_is_partial();
    let mut suggestions = MOST_SUGGESTIONS;
    let is_echo = |problem: &Problem| {
        let of_the_tree = ["several_bases", "unreachable_link", "no_base", "unknown_link", "unknown_joint"];
        is_cut && of_the_tree.contains(&problem.code) || places.has_reported(problem.element, problem.attribute)
    };
    let problems = description.check().into_iter().filter(|problem| !is_echo(problem));
    problems
        .map(|problem| Finding {
            severity: problem.severity,
            code: problem.code,
            span: places.span(problem.element, problem.attribute),
            message: problem.to_string(),
            topic: None,
            help: suggestion(&problem, description, &mut suggestions),
        })
        .collect()
}

/// The nearest existing name of a link or joint.
fn suggestion(problem: &Problem, description: &Description, suggestions: &mut usize) -> Option<String> {
    let (Element::Joint(i), "unknown_link" | "unknown_joint") = (problem.element, problem.code) else { return None };
    let joint = description.joints.get(i)?;
    let count = description.links.len().max(description.joints.len());
    *suggestions = suggestions.checked_sub(1).filter(|_| count <= MOST_NAMES)?;
    let links = || description.links.iter().map(|link| link.name.as_str());
    let others = || description.joints.iter().map(|joint| joint.name.as_str()).filter(|&name| name != joint.name);
    let near = |name: &str| match problem.code {
        "unknown_link" => did_you_mean(name, links()),
        _ => did_you_mean(name, others()),
    };
    match problem.attribute {
        "parent" => near(&joint.parent),
        "child" => near(&joint.child),
        _ => near(&joint.mimic.as_ref()?.joint),
    }
}
