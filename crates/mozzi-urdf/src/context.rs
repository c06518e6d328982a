//! What the readers of elements share.

use crate::finding::Findings;
use std::collections::BTreeSet;

/// Findings so far, and the kinds of unknown things that were already named.
#[derive(Default)]
pub(crate) struct Context {
    pub findings: Findings,
    kinds: BTreeSet<(String, String, &'static str)>,
}

impl Context {
    /// Is this the first of its kind in such a parent?
    pub fn first_of_kind(&mut self, parent: &str, name: &str, what: &'static str) -> bool {
        self.kinds.insert((parent.to_string(), name.to_string(), what))
    }
}
