//! Errors and warnings about a description.

use alloc::string::String;
use core::fmt;

/// The element that a problem concerns, by its index in the [`Description`](super::Description).
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
    /// `rotors[i]`.
    Rotor(usize),
    /// `constraints[i]`.
    Constraint(usize),
    /// `states[i]`.
    State(usize),
}

/// Severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The robot can be built; the user should know.
    Warning,
    /// The robot is refused.
    Error,
}

/// A problem of a description.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Warning or error.
    pub severity: Severity,
    /// A short name for programs, such as `unknown_link`.
    pub code: &'static str,
    /// The element that it concerns.
    pub element: Element,
    /// The element in words, such as "link `forearm`".
    pub subject: String,
    /// The attribute of the element, such as `parent` or `inertia`.
    pub attribute: &'static str,
    /// The message: the value found, and the values expected.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.subject, self.attribute, self.message)
    }
}
