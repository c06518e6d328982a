//! One thing wrong with a file: what, where, how bad, how to mend it.

use crate::finding::Finding;
use crate::source::{Position, Source};
use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use mozzi::model::Severity;
use std::fmt;
use std::ops::Range;

/// Something wrong with a file. Displays as `file:line:column: error: message`; as a [`miette::Diagnostic`] it also shows
/// the line with a caret under the value.
#[derive(Clone)]
pub struct Diagnostic {
    severity: Severity,
    code: String,
    message: String,
    position: Position,
    span: Range<usize>,
    help: Option<String>,
    source: Source,
}

impl Diagnostic {
    pub(crate) fn new(finding: Finding, position: Position, source: Source) -> Self {
        let Finding { severity, code, span, message, help } = finding;
        Diagnostic { severity, code: format!("mozzi::urdf::{code}"), message, position, span, help, source }
    }

    /// Error (the file is refused) or warning (it is loaded).
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// For programs, such as `mozzi::urdf::zero_axis`; see [`explain`](crate::explain).
    pub fn code(&self) -> &str {
        &self.code
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

    /// The bytes of the text (without its byte order mark) that are meant.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// How to mend it.
    pub fn help(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The text that the span covers.
    pub fn excerpt(&self) -> &str {
        &self.source.text[self.span.clone()]
    }

    pub(crate) fn into_error(self) -> Self {
        Diagnostic { severity: Severity::Error, ..self }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{}:{}:{}: {severity}: {}", self.file(), self.line(), self.column(), self.message)
    }
}

impl fmt::Debug for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} [{}]", self.code)
    }
}

impl std::error::Error for Diagnostic {}

impl miette::Diagnostic for Diagnostic {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(&self.code))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        (!self.source.text.is_empty()).then_some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(None, self.span.clone()))))
    }
}

impl SourceCode for Source {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, before, after)?;
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.to_string(),
            found.data(),
            *found.span(),
            found.line(),
            found.column(),
            found.line_count(),
        )))
    }
}
