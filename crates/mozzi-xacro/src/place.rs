//! Places in files, and the macro calls that lead to them.

use std::ops::Range;
use std::sync::Arc;

/// A place in a file, and the call of the macro that holds it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Place {
    pub file: u32,
    pub start: u32,
    pub end: u32,
    pub call: Option<Arc<Call>>,
}

/// A call of a macro: its place, which may itself be inside a macro, and its arguments.
#[derive(Debug)]
pub(crate) struct Call {
    pub place: Place,
    pub arguments: String,
}

impl Place {
    pub fn new(file: u32, span: Range<usize>) -> Self {
        Place { file, start: span.start as u32, end: span.end as u32, call: None }
    }

    pub fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The place, expanded in a call.
    pub fn called(&self, call: &Arc<Call>) -> Place {
        Place { call: Some(call.clone()), ..*self }
    }
}
