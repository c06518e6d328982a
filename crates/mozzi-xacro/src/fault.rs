//! Errors during expansion, before their place is looked up.

use crate::place::Place;

/// A message, and the part of its place that is known so far.
#[derive(Debug)]
pub(crate) struct Fault {
    pub message: String,
    /// The byte in the text that is evaluated.
    pub at: Option<usize>,
    /// The place in a file.
    pub place: Option<Place>,
    /// A file could not be opened: an optional include ignores this.
    pub is_missing_file: bool,
}

pub(crate) type Result<T, E = Box<Fault>> = std::result::Result<T, E>;

impl Fault {
    pub fn new(message: impl Into<String>) -> Box<Fault> {
        Box::new(Fault { message: message.into(), at: None, place: None, is_missing_file: false })
    }

    pub fn at(at: usize, message: impl Into<String>) -> Box<Fault> {
        Box::new(Fault { at: Some(at), ..*Fault::new(message) })
    }

    pub fn missing_file(message: impl Into<String>) -> Box<Fault> {
        Box::new(Fault { is_missing_file: true, ..*Fault::new(message) })
    }

    /// Moves the place by this many bytes, for a text that begins earlier.
    pub fn further(mut self: Box<Fault>, by: usize) -> Box<Fault> {
        self.at = self.at.map(|at| at + by);
        self
    }

    /// Sets the place to a byte of the text, unless it is already known.
    pub fn or_at(mut self: Box<Fault>, at: usize) -> Box<Fault> {
        if self.place.is_none() {
            self.at = self.at.or(Some(at));
        }
        self
    }
}
