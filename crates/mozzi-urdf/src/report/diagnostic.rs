//! A diagnostic: message, place, severity, remedy.

use crate::report::consequence::{Consequence, consequence};
use crate::report::explain::remedy;
use crate::report::finding::{Finding, Topic};
use crate::report::visible::visible;
use crate::text::dialect::Dialect;
use crate::text::source::{Position, Source};
use mozzi::model::Severity;
use std::fmt;
use std::ops::Range;

/// An error or a warning in a file. Displays as `file:line:column: error: message`; [`pretty`](Self::pretty) shows the
/// line with a mark under the value.
#[derive(Clone)]
pub struct Diagnostic {
    severity: Severity,
    code: String,
    message: String,
    position: Position,
    span: Range<usize>,
    help: Option<String>,
    topic: Option<Topic>,
    source: Source,
    calls: String,
}

impl Diagnostic {
    pub(crate) fn new(finding: Finding, position: Position, source: Source, dialect: Dialect) -> Self {
        let Finding { severity, code, span, message, help, topic } = finding;
        let code = format!("{}{code}", dialect.prefix());
        let help = help.or_else(|| remedy(&code).map(str::to_string));
        Diagnostic { severity, code, message, position, span, help, topic, source, calls: String::new() }
    }

    /// Without lines of the file.
    pub(crate) fn hidden(self) -> Self {
        Diagnostic { source: self.source.hidden(), ..self }
    }

    /// The macro calls of xacro that lead to the place: `, from ur.urdf.xacro:40 (prefix = "left_")`.
    pub(crate) fn called_from(self, calls: String) -> Self {
        Diagnostic { calls, ..self }
    }

    /// Error (the file is refused) or warning (it is loaded).
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// The code, such as `mozzi::urdf::zero_axis` or `mozzi::mjcf::zero_axis`; see [`explain`](crate::report::explain).
    pub fn code(&self) -> &str {
        &self.code
    }

    /// Its consequence for the results.
    pub fn consequence(&self) -> Consequence {
        match self.topic {
            Some(_) => Consequence::Unused,
            None => consequence(&self.code),
        }
    }

    pub(crate) fn topic(&self) -> Option<Topic> {
        self.topic
    }

    /// The element, what was found there, and what was expected.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The file's name as given.
    pub fn file(&self) -> &str {
        &self.source.name
    }

    /// From 1.
    pub fn line(&self) -> usize {
        self.position.line
    }

    /// From 1, in characters.
    pub fn column(&self) -> usize {
        self.position.column
    }

    /// The calls of xacro macros that lead to the place, innermost first: `, from ur.urdf.xacro:40 (prefix = "left_")`
    /// for each. Empty outside of macros.
    pub fn calls(&self) -> &str {
        &self.calls
    }

    /// The byte range in the text (without its byte order mark).
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The remedy.
    pub fn help(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The text that the span covers; empty in an included file that is not a model.
    pub fn excerpt(&self) -> &str {
        if self.source.is_shown { &self.source.text[self.span.clone()] } else { "" }
    }

    /// The whole text, for excerpts; `None` if excerpts must not be shown.
    #[cfg(feature = "pretty")]
    pub(crate) fn text(&self) -> Option<&str> {
        self.source.is_shown.then_some(&self.source.text)
    }

    pub(crate) fn into_error(self) -> Self {
        Diagnostic { severity: Severity::Error, ..self }
    }

    pub(crate) fn into_warning(self) -> Self {
        Diagnostic { severity: Severity::Warning, ..self }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let (file, message) = (visible(self.file()), visible(&self.message));
        write!(f, "{file}:{}:{}{}: {severity}: {message}", self.line(), self.column(), visible(&self.calls))
    }
}

impl fmt::Debug for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} [{}]", self.code)
    }
}

impl std::error::Error for Diagnostic {}
