//! What the readers of elements share.

use crate::dialect::Dialect;
use crate::finding::Findings;
use crate::spelling::did_you_mean;
use std::collections::{BTreeMap, BTreeSet};

/// Findings so far, and the kinds of unknown things that were met.
#[derive(Default)]
pub(crate) struct Context {
    pub findings: Findings,
    /// The language of the text.
    pub dialect: Dialect,
    /// Places of values that were found to be no numbers: a default may be used often, and is reported once.
    pub unreadable: BTreeSet<usize>,
    kinds: BTreeMap<(String, String, &'static str), Option<String>>,
}

/// Something that is not known.
pub(crate) enum Unknown {
    /// Near a word that is: "did you mean `x`?"
    Misspelled(String),
    /// The first of its kind in such a parent.
    First,
    /// Not the first.
    Again,
}

impl Context {
    /// Nothing met yet but what was found before.
    pub fn new(findings: Findings, dialect: Dialect) -> Self {
        Context { findings, dialect, ..Context::default() }
    }

    /// What to make of a name that is not known, `what` it names, in such a parent.
    pub fn unknown<'k>(
        &mut self,
        parent: &str,
        name: &str,
        what: &'static str,
        known: impl IntoIterator<Item = &'k str>,
    ) -> Unknown {
        let kind = (parent.to_string(), name.to_string(), what);
        match self.kinds.get(&kind) {
            Some(Some(help)) => Unknown::Misspelled(help.clone()),
            Some(None) => Unknown::Again,
            None => {
                let help = did_you_mean(name, known);
                self.kinds.insert(kind, help.clone());
                help.map_or(Unknown::First, Unknown::Misspelled)
            }
        }
    }
}
