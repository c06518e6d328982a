//! The report for people: the line of the file, a mark under the value, and the remedy.

use crate::consequence::Consequence;
use crate::diagnostic::Diagnostic;
use crate::error::{LoadError, PRINTED};
use crate::visible::visible;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents};
use miette::{SourceCode, SourceSpan, SpanContents};
use mozzi::model::Severity;
use std::fmt::{self, Write};
use std::ops::Range;

/// Longer lines are shown only in part.
const LONG: usize = 400;

/// Style of a rendered report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// ASCII only, for files and tests.
    Ascii,
    /// Lines and signs of Unicode, no colour.
    Unicode,
    /// Unicode and colours of the terminal.
    Color,
}

impl Style {
    fn handler(self) -> GraphicalReportHandler {
        let theme = match self {
            Style::Ascii => GraphicalTheme::none(),
            Style::Unicode => GraphicalTheme::unicode_nocolor(),
            Style::Color => GraphicalTheme::unicode(),
        };
        GraphicalReportHandler::new_themed(theme).with_width(120).with_context_lines(1).with_links(false)
    }
}

impl Diagnostic {
    /// The rendered report.
    pub fn pretty(&self, style: Style) -> String {
        let mut text = String::new();
        let view = self.text().map(|text| View::new(self, text));
        match view.map(|view| style.handler().render_report(&mut text, &view)) {
            Some(Ok(())) => text,
            _ => format!("{self}\n"),
        }
    }
}

impl LoadError {
    /// The rendered report: warnings, then errors, each with its place.
    pub fn pretty(&self, style: Style) -> String {
        let mut text = String::new();
        let is_warning =
            |found: &&Diagnostic| found.severity() == Severity::Warning && found.consequence() != Consequence::Unused;
        let warnings = self.diagnostics().iter().filter(is_warning);
        for diagnostic in warnings.take(PRINTED).chain(self.errors().take(PRINTED)) {
            text.push_str(&diagnostic.pretty(style));
        }
        // writing to a String cannot fail
        let _ = match self.more() {
            0 => write!(text, "{}", self.headline()),
            more => write!(text, "{}, {more} of them not shown", self.headline()),
        };
        text
    }
}

/// A diagnostic in the form that the report needs.
struct View<'d> {
    diagnostic: &'d Diagnostic,
    /// The shown part of the text, its start in the file, its first line from 0, and the marked range. Places count the
    /// text before this part as in the file, and this part as shown.
    shown: String,
    start: usize,
    first_line: usize,
    marked: Range<usize>,
}

impl<'d> View<'d> {
    /// The lines around the place; only part of a long line.
    fn new(diagnostic: &'d Diagnostic, text: &str) -> Self {
        let (span, line) = (diagnostic.span(), diagnostic.line() - 1);
        let start_of_line = |at: usize| text[..at].rfind('\n').map_or(0, |k| k + 1);
        let end_of_line = |at: usize| text[at..].find('\n').map_or(text.len(), |k| at + k);
        let (start, end) = (start_of_line(span.start), end_of_line(span.start));
        let before = start_of_line(start.saturating_sub(1));
        let after = end_of_line((end + 1).min(text.len()));
        let (shown, first_line) = if after - before <= LONG {
            (before..after, line - usize::from(before < start))
        } else if end - start <= LONG {
            (start..end, line)
        } else {
            let from = text.ceil_char_boundary(span.start.saturating_sub(LONG / 4)).max(start);
            (from..text.floor_char_boundary(span.start + LONG / 4).min(end), line)
        };
        let marked = span.start..span.end.min(shown.end).max(span.start);
        // \r is a part of a line's end
        let part = |range: Range<usize>| visible(&text[range].replace('\r', ""));
        let begin = shown.start + part(shown.start..marked.start).len();
        let end = begin + part(marked).len();
        View { diagnostic, marked: begin..end, start: shown.start, shown: part(shown), first_line }
    }
}

impl fmt::Display for View<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(self.diagnostic.message()))?;
        f.write_str(&visible(self.diagnostic.calls()))
    }
}

impl fmt::Debug for View<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for View<'_> {}

impl miette::Diagnostic for View<'_> {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.diagnostic.code()))
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.severity() {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.diagnostic.help().map(|help| Box::new(visible(help)) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(None, self.marked.clone()))))
    }
}

impl SourceCode for View<'_> {
    fn read_span<'a>(
        &'a self,
        _: &SourceSpan,
        before: usize,
        _: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // the report first requests the place itself, with no lines before it, then the text to show
        let (shown, line, column) = match before {
            0 => (self.marked.clone(), self.diagnostic.line() - 1, self.diagnostic.column() - 1),
            _ => (self.start..self.start + self.shown.len(), self.first_line, 0),
        };
        let text = &self.shown[shown.start - self.start..shown.end - self.start];
        let (name, count) = (visible(self.diagnostic.file()), text.lines().count());
        Ok(Box::new(MietteSpanContents::new_named(name, text.as_bytes(), shown.into(), line, column, count)))
    }
}
