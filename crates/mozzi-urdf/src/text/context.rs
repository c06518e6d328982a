//! State that the readers of elements share.

use crate::report::finding::{Finding, Findings};
use crate::report::spelling::nearest;
use crate::text::dialect::Dialect;
use crate::text::version::Version;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Findings so far, and the kinds of unknown names that were found.
#[derive(Default)]
pub(crate) struct Context {
    pub findings: Findings,
    /// The language of the text.
    pub dialect: Dialect,
    /// The version of URDF that the file declares.
    pub version: Version,
    /// Places of invalid numbers: a default may be used often, but is reported once.
    pub unreadable: BTreeSet<usize>,
    /// The first places of attributes that do not affect the dynamics of the tree, by element and attribute.
    pub left_out: BTreeMap<(String, &'static str), Range<usize>>,
    kinds: BTreeMap<(String, String, &'static str), Option<String>>,
    /// The first finding of each kind that may occur often, and the number of its repetitions.
    repeated: BTreeMap<String, (Finding, usize)>,
}

/// An unknown name.
pub(crate) enum Unknown {
    /// Close to this known word.
    Misspelled(String),
    /// The first of its kind in such a parent.
    First,
    /// Not the first.
    Again,
}

impl Context {
    /// A context with these findings, in which no unknown name was found yet.
    pub fn new(findings: Findings, dialect: Dialect) -> Self {
        Context { findings, dialect, ..Context::default() }
    }

    /// Notes an unused attribute, to be listed at the end.
    pub fn leave_out(&mut self, element: &str, attribute: &'static str, span: Range<usize>) {
        self.left_out.entry((element.to_string(), attribute)).or_insert(span);
    }

    /// A finding of a kind that is reported once, with the number of its repetitions.
    pub fn repeat(&mut self, kind: &str, finding: Finding) {
        self.repeated.entry(kind.to_string()).or_insert((finding, 0)).1 += 1;
    }

    /// Reports the findings of [`repeat`](Self::repeat).
    pub fn report_repeated(&mut self) {
        for (mut finding, count) in std::mem::take(&mut self.repeated).into_values() {
            if count > 1 {
                finding.message.push_str(&format!(" (here, and {} more)", count - 1));
            }
            self.findings.add(finding);
        }
    }

    /// Classifies an unknown name in such a parent; `what` is the kind of name.
    pub fn unknown<'k>(
        &mut self,
        parent: &str,
        name: &str,
        what: &'static str,
        known: impl IntoIterator<Item = &'k str>,
    ) -> Unknown {
        let kind = (parent.to_string(), name.to_string(), what);
        match self.kinds.get(&kind) {
            Some(Some(near)) => Unknown::Misspelled(near.clone()),
            Some(None) => Unknown::Again,
            None => {
                let near = nearest(name, known).map(str::to_string);
                self.kinds.insert(kind, near.clone());
                near.map_or(Unknown::First, Unknown::Misspelled)
            }
        }
    }
}
