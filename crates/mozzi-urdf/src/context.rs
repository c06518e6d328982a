//! What the readers of elements share.

use crate::dialect::Dialect;
use crate::finding::Findings;
use crate::spelling::did_you_mean;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Findings so far, and the kinds of unknown things that were met.
#[derive(Default)]
pub(crate) struct Context {
    pub findings: Findings,
    /// The language of the text.
    pub dialect: Dialect,
    /// Places of values that were found to be no numbers: a default may be used often, and is reported once.
    pub unreadable: BTreeSet<usize>,
    /// Attributes that say nothing about the dynamics of the tree, by the element that they stand on.
    pub left_out: BTreeMap<String, LeftOut>,
    kinds: BTreeMap<(String, String, &'static str), Option<String>>,
}

/// Attributes of one kind of element that are left out, and the place of the first.
pub(crate) struct LeftOut {
    pub span: Range<usize>,
    pub names: BTreeSet<&'static str>,
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

    /// Notes an attribute that is left out, to be listed at the end.
    pub fn leave_out(&mut self, element: &str, attribute: &'static str, span: Range<usize>) {
        let first = || LeftOut { span, names: BTreeSet::new() };
        self.left_out.entry(element.to_string()).or_insert_with(first).names.insert(attribute);
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
