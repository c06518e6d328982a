//! Validation of a description: all errors and warnings, each with its place.

mod bodies;
mod constraint;
mod mimic;
mod numbers;
mod overflow;
mod rotor;
mod states;
mod tree;
mod units;

use super::description::Description;
use super::error::names;
use super::problem::{Element, Problem, Severity};
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// Limit on the number of problems collected of each severity.
const MOST_PROBLEMS: usize = 1000;

/// Collects problems of one description.
struct Report<'a> {
    description: &'a Description,
    problems: Vec<Problem>,
    errors: usize,
    warnings: usize,
}

impl Report<'_> {
    fn add(
        &mut self,
        severity: Severity,
        element: Element,
        attribute: &'static str,
        code: &'static str,
        message: String,
    ) {
        let count = match severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        if *count > MOST_PROBLEMS {
            return;
        }
        let d = self.description;
        let subject = match element {
            Element::Robot if d.name.is_empty() => "robot".to_string(),
            Element::Robot => format!("robot `{}`", d.name),
            Element::Link(i) => format!("link `{}`", d.links[i].name),
            Element::Joint(i) => format!("joint `{}`", d.joints[i].name),
            Element::Frame(i) => format!("frame `{}`", d.frames[i].name),
            Element::Rotor(i) => format!("rotor `{}`", d.rotors[i].name),
            Element::Constraint(i) => format!("constraint `{}`", d.constraints[i].name),
            Element::State(i) => format!("state `{}`", d.states[i].name),
        };
        self.problems.push(Problem { severity, code, element, subject, attribute, message });
    }

    fn error(&mut self, element: Element, attribute: &'static str, code: &'static str, message: String) {
        self.add(Severity::Error, element, attribute, code, message);
    }

    /// Reports an error for each duplicate name.
    fn unique<'n>(&mut self, names: impl Iterator<Item = (Element, &'n str)>) -> BTreeMap<&'n str, Element> {
        let mut first = BTreeMap::new();
        for (element, name) in names {
            if name.is_empty() {
                self.error(element, "name", "empty_name", "is empty, expected a name".to_string());
            } else if first.contains_key(name) {
                self.error(
                    element,
                    "name",
                    "duplicate_name",
                    format!("`{name}` is used twice, expected a unique name"),
                );
            } else {
                first.insert(name, element);
            }
        }
        first
    }
}

impl Description {
    /// All errors and warnings: names, the tree, numbers, inertias, mimic joints, states. Empty for a valid robot; at
    /// most the first thousand of each severity. Time and memory are linear in the size of the robot.
    pub fn check(&self) -> Vec<Problem> {
        let mut report = Report { description: self, problems: Vec::new(), errors: 0, warnings: 0 };
        let frames = (self.links.iter().enumerate().map(|(i, link)| (Element::Link(i), link.name.as_str())))
            .chain(self.frames.iter().enumerate().map(|(i, frame)| (Element::Frame(i), frame.name.as_str())));
        let frames = report.unique(frames);
        let joints =
            report.unique(self.joints.iter().enumerate().map(|(i, joint)| (Element::Joint(i), joint.name.as_str())));
        let link = |name: &str| match frames.get(name) {
            Some(&Element::Link(i)) => Some(i),
            _ => None,
        };
        report.numbers();
        let tree = report.tree(link);
        report.inertias(tree.as_ref());
        report.mimics(&joints);
        report.rotors(&joints);
        report.constraints(&frames, &joints, tree.as_ref());
        report.states(&joints);
        report.units();
        for (i, frame) in self.frames.iter().enumerate() {
            if link(&frame.link).is_none() {
                report.error(Element::Frame(i), "link", "unknown_link", unknown_link(self, &frame.link));
            }
        }
        if let Some(name) = &self.end_effector
            && !frames.contains_key(name.as_str())
        {
            report.error(
                Element::Robot,
                "end effector",
                "unknown_frame",
                format!("there is no link or frame `{name}`"),
            );
        }
        report.overflow();
        report.problems
    }
}

fn unknown_link(description: &Description, name: &str) -> String {
    format!("there is no link `{name}`, expected one of {}", names(&description.links))
}
