//! Findings in a log or a fit that do not stop it.

use core::fmt;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Worth knowing.
    Note,
    /// The result may be wrong because of it.
    Warning,
    /// The log contradicts itself or the robot: the result would be wrong. [`identify`](crate::identify()) refuses such
    /// a log, unless [`Options::trust_log`](crate::Options::trust_log) is set.
    Fault,
}

/// One remark about a log or a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// A word for programs, such as `repeated_rows`.
    pub code: &'static str,
    /// How much it matters.
    pub level: Level,
    /// A sentence: what, where, how much, and what helps.
    pub text: String,
}

impl Finding {
    /// Worth knowing.
    pub fn note(code: &'static str, text: impl Into<String>) -> Self {
        Finding { code, level: Level::Note, text: text.into() }
    }

    /// The result may be wrong because of it.
    pub fn warning(code: &'static str, text: impl Into<String>) -> Self {
        Finding { code, level: Level::Warning, text: text.into() }
    }

    /// The log contradicts itself or the robot.
    pub fn fault(code: &'static str, text: impl Into<String>) -> Self {
        Finding { code, level: Level::Fault, text: text.into() }
    }
}

/// Faults that cause others, and what they cause.
const CAUSES: [&str; 3] = ["short", "at_rest", "stuck"];
const CONSEQUENCES: [&str; 9] = [
    "velocity",
    "swapped_joints",
    "swapped_columns",
    "sign",
    "unit",
    "causal_filter",
    "position_jump",
    "gravity",
    "contradiction",
];

/// Leaves out what follows from a fault that is among the findings.
pub(crate) fn keep_causes(findings: &mut Vec<Finding>) {
    let is_cause = |finding: &Finding| finding.level == Level::Fault && CAUSES.contains(&finding.code);
    if findings.iter().any(is_cause) {
        findings.retain(|finding| !CONSEQUENCES.contains(&finding.code));
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = match self.level {
            Level::Note => "note",
            Level::Warning => "warning",
            Level::Fault => "fault",
        };
        write!(f, "{level}: {} ({})", self.text, self.code)
    }
}
