//! Is a description a robot? Everything that is wrong with it, each with its place.

use super::description::{Description, JointKind};
use super::error::names;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

/// What a problem concerns, by its place in the [`Description`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Element {
    /// The robot itself.
    Robot,
    /// `links[i]`.
    Link(usize),
    /// `joints[i]`.
    Joint(usize),
    /// `frames[i]`.
    Frame(usize),
}

/// How bad a problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The robot is built, and the user is told.
    Warning,
    /// The robot is refused.
    Error,
}

/// Something wrong with a description.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Warning or error.
    pub severity: Severity,
    /// A short name for programs, such as `unknown_link`.
    pub code: &'static str,
    /// What it concerns.
    pub element: Element,
    /// "link `forearm`", for readers.
    pub subject: String,
    /// Which of its attributes, such as `parent` or `inertia`.
    pub attribute: &'static str,
    /// What was found, and what was expected.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.subject, self.attribute, self.message)
    }
}

/// Collects problems of one description.
struct Report<'a> {
    description: &'a Description,
    problems: Vec<Problem>,
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
        let d = self.description;
        let subject = match element {
            Element::Robot => format!("robot `{}`", d.name),
            Element::Link(i) => format!("link `{}`", d.links[i].name),
            Element::Joint(i) => format!("joint `{}`", d.joints[i].name),
            Element::Frame(i) => format!("frame `{}`", d.frames[i].name),
        };
        self.problems.push(Problem { severity, code, element, subject, attribute, message });
    }

    fn error(&mut self, element: Element, attribute: &'static str, code: &'static str, message: String) {
        self.add(Severity::Error, element, attribute, code, message);
    }

    /// An error for each name that came before.
    fn unique<'n>(&mut self, names: impl Iterator<Item = (Element, &'n str)>) -> BTreeMap<&'n str, Element> {
        let mut first = BTreeMap::new();
        for (element, name) in names {
            if name.is_empty() {
                self.error(element, "name", "empty_name", "is empty, expected a name".to_string());
            } else if first.contains_key(name) {
                self.error(element, "name", "duplicate_name", format!("`{name}` is taken, expected a name of its own"));
            } else {
                first.insert(name, element);
            }
        }
        first
    }
}

impl Description {
    /// All problems, errors and warnings: names, the tree, numbers, inertias, followers. Empty for a sound robot.
    pub fn check(&self) -> Vec<Problem> {
        let mut report = Report { description: self, problems: Vec::new() };
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
        report.tree(link);
        report.followers(&joints);
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
        report.problems
    }
}

fn unknown_link(description: &Description, name: &str) -> String {
    let known: Vec<&str> = description.links.iter().map(|link| link.name.as_str()).collect();
    format!("there is no link `{name}`, expected one of {}", names(&known))
}

impl Report<'_> {
    /// Finite numbers, masses and frictions of the right sign, inertias of bodies that can exist.
    fn numbers(&mut self) {
        let d = self.description;
        if !d.gravity.iter().all(|x| x.is_finite()) {
            self.error(Element::Robot, "gravity", "not_finite", format!("is {:?}, expected finite numbers", d.gravity));
        }
        for (i, link) in d.links.iter().enumerate() {
            let (verdict, element) = (link.inertia.verdict(), Element::Link(i));
            if link.inertia.to_matrix().as_flattened().iter().any(|x| !x.is_finite()) {
                self.error(element, "inertia", "not_finite", "has entries that are not finite".to_string());
            } else if verdict.mass < 0.0 {
                self.error(element, "mass", "negative_mass", format!("{verdict}"));
            } else if !verdict.is_physical() {
                self.add(Severity::Warning, element, "inertia", "unphysical_inertia", format!("{verdict}"));
            }
        }
        for (i, joint) in d.joints.iter().enumerate() {
            let element = Element::Joint(i);
            if !joint.origin.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
                self.error(element, "origin", "not_finite", "has entries that are not finite".to_string());
            }
            for (attribute, x) in
                [("damping", joint.damping), ("friction", joint.friction), ("armature", joint.armature)]
            {
                if !(x >= 0.0 && x.is_finite()) {
                    self.error(
                        element,
                        attribute,
                        "negative_friction",
                        format!("is {x}, expected a finite number, at least 0"),
                    );
                }
            }
            if let Some([low, high]) = joint.limits.position
                && !(low <= high)
            {
                self.error(
                    element,
                    "limits",
                    "reversed_limits",
                    format!("go from {low} to {high}, expected the lower first"),
                );
            }
            for (attribute, limit) in [("velocity limit", joint.limits.velocity), ("effort limit", joint.limits.effort)]
            {
                if limit.is_some_and(|x| !(x >= 0.0)) {
                    self.error(
                        element,
                        attribute,
                        "negative_limit",
                        format!("is {}, expected at least 0", limit.unwrap_or_default()),
                    );
                }
            }
        }
        for (i, frame) in d.frames.iter().enumerate() {
            if !frame.T.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
                self.error(Element::Frame(i), "T", "not_finite", "has entries that are not finite".to_string());
            }
        }
    }

    /// Exactly one base, every link reached from it once.
    fn tree(&mut self, link: impl Fn(&str) -> Option<usize>) {
        let d = self.description;
        if d.links.is_empty() {
            self.error(Element::Robot, "links", "no_links", "there are none, expected at least one".to_string());
            return;
        }
        let mut parent_joint: Vec<Option<usize>> = vec![None; d.links.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); d.links.len()];
        let mut complete = true;
        for (i, joint) in d.joints.iter().enumerate() {
            let (parent, child) = (link(&joint.parent), link(&joint.child));
            for (attribute, found, name) in [("parent", parent, &joint.parent), ("child", child, &joint.child)] {
                if found.is_none() {
                    self.error(Element::Joint(i), attribute, "unknown_link", unknown_link(d, name));
                    complete = false;
                }
            }
            let (Some(parent), Some(child)) = (parent, child) else { continue };
            if let Some(first) = parent_joint[child] {
                let message = format!(
                    "link `{}` is already the child of joint `{}`: a closed loop, which mozzi does not compute; expected a tree",
                    joint.child, d.joints[first].name
                );
                self.error(Element::Joint(i), "child", "loop_closure", message);
                complete = false;
            } else {
                parent_joint[child] = Some(i);
                children[parent].push(child);
            }
        }
        let roots: Vec<usize> = (0..d.links.len()).filter(|&i| parent_joint[i].is_none()).collect();
        if !complete {
            return; // what follows would only be an echo
        }
        let name = |&i: &usize| format!("`{}`", d.links[i].name);
        match roots.as_slice() {
            [] => {
                let message =
                    "every link is the child of a joint: a closed ring; expected one link, the base, that is no child"
                        .to_string();
                self.error(Element::Robot, "joints", "no_base", message);
            }
            [root] => {
                let (mut reached, mut stack) = (vec![false; d.links.len()], vec![*root]);
                while let Some(i) = stack.pop() {
                    reached[i] = true;
                    stack.extend(&children[i]);
                }
                for i in (0..d.links.len()).filter(|&i| !reached[i]) {
                    let message = format!(
                        "is not connected to the base `{}`: it hangs in a closed ring of joints",
                        d.links[*root].name
                    );
                    self.error(Element::Link(i), "joints", "unreachable_link", message);
                }
            }
            [first, others @ ..] => {
                for i in others {
                    let message = format!(
                        "is no joint's child, and neither is {}: expected one base, so a joint that leads to this link is missing",
                        name(first)
                    );
                    self.error(Element::Link(*i), "joints", "several_bases", message);
                }
            }
        }
    }

    /// Every follower follows a joint that moves, and not itself.
    fn followers(&mut self, joints: &BTreeMap<&str, Element>) {
        let d = self.description;
        let master = |i: usize| {
            let mimic = d.joints[i].mimic.as_ref()?;
            match joints.get(mimic.joint.as_str()) {
                Some(&Element::Joint(k)) => Some(k),
                _ => None,
            }
        };
        for (i, joint) in d.joints.iter().enumerate() {
            let (Some(mimic), element) = (&joint.mimic, Element::Joint(i)) else { continue };
            if !(mimic.ratio.is_finite() && mimic.offset.is_finite()) {
                let message = format!("ratio {} and offset {}, expected finite numbers", mimic.ratio, mimic.offset);
                self.error(element, "mimic", "not_finite", message);
            }
            let Some(k) = master(i) else {
                let known: Vec<&str> = d.joints.iter().map(|joint| joint.name.as_str()).collect();
                let message = format!("there is no joint `{}`, expected one of {}", mimic.joint, names(&known));
                self.error(element, "mimic", "unknown_joint", message);
                continue;
            };
            if joint.kind == JointKind::Fixed {
                let message = format!("follows `{}`, but is fixed: it does not move", mimic.joint);
                self.add(Severity::Warning, element, "mimic", "fixed_follower", message);
            } else if d.joints[k].kind == JointKind::Fixed {
                self.error(
                    element,
                    "mimic",
                    "fixed_master",
                    format!("joint `{}` is fixed, expected one that moves", mimic.joint),
                );
            }
            // a chain of followers longer than all joints goes in a circle
            let end = (0..d.joints.len()).try_fold(i, |at, _| master(at));
            if end.is_some() {
                let message =
                    format!("following `{}` leads back in a circle, expected a joint that follows none", mimic.joint);
                self.error(element, "mimic", "circular_mimic", message);
            }
        }
    }
}
