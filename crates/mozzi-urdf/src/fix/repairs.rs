//! The repairs of a robot, and what they leave open.

use super::{Proposal, apply};
use crate::report::spelling::counted;
use crate::{Consequence, LoadError, Policy, Settings, Severity, parse_with};
use std::collections::BTreeMap;

/// The proposals for a robot.
#[derive(Clone, Debug)]
pub struct Repairs {
    /// In the order of the text.
    pub proposals: Vec<Proposal>,
    /// The links of which no shape could be read, each with the reason; their inertias were not compared with shapes.
    pub unread: BTreeMap<String, String>,
    /// The numbers of errors and warnings of the text with all proposals applied.
    pub left: [usize; 2],
}

impl Repairs {
    /// Counts the findings that remain.
    pub(super) fn count_left(&mut self, file_name: &str, text: &str, settings: &Settings) {
        let settings = Settings { policy: Policy::Default, ..settings.clone() };
        let found = match parse_with(file_name, apply(text, &self.proposals), settings) {
            Ok(loaded) => loaded.warnings,
            Err(LoadError::Refused { diagnostics, .. }) => diagnostics,
            Err(_) => Vec::new(),
        };
        let of = |severity| {
            let is_counted = |one: &&crate::Diagnostic| one.consequence() != Consequence::Unused;
            found.iter().filter(is_counted).filter(|one| one.severity() == severity).count()
        };
        self.left = [of(Severity::Error), of(Severity::Warning)];
    }

    /// All that is left open, each with a code and in a sentence.
    pub fn notes(&self) -> Vec<(&'static str, String)> {
        let mut notes = Vec::new();
        if let Some(first) = self.unread.values().next() {
            let links = counted(self.unread.len(), "link");
            notes.push(("unread_shapes", format!("the shapes of {links} were not read: {first}")));
        }
        let [errors, warnings] = self.left;
        let counts = [(errors, "error"), (warnings, "warning")].into_iter().filter(|(count, _)| *count > 0);
        let counts: Vec<String> = counts.map(|(count, what)| counted(count, what)).collect();
        if !counts.is_empty() {
            let verb = if errors + warnings == 1 { "has" } else { "have" };
            notes.push(("without_proposal", format!("{} of `mozzi check` {verb} no proposal", counts.join(" and "))));
        }
        notes
    }
}
