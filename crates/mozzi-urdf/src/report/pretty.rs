//! The report for people: the line of the file, a mark under the value, and the remedy.

use crate::report::consequence::Consequence;
use crate::report::diagnostic::Diagnostic;
use crate::report::error::{LoadError, PRINTED};
use crate::report::visible::visible;
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use mozzi::model::Severity;
use std::fmt::Write;
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
    fn renderer(self) -> Renderer {
        let (renderer, decor) = match self {
            Style::Ascii => (Renderer::plain(), DecorStyle::Ascii),
            Style::Unicode => (Renderer::plain(), DecorStyle::Unicode),
            Style::Color => (Renderer::styled(), DecorStyle::Unicode),
        };
        renderer.decor_style(decor).term_width(120)
    }
}

impl Diagnostic {
    /// The rendered report, which ends with an empty line.
    pub fn pretty(&self, style: Style) -> String {
        let Some(text) = self.text() else { return format!("{self}\n\n") };
        let level = match self.severity() {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(visible(self.message()) + &visible(self.calls())).id(self.code());
        let excerpt = Excerpt::of(self, text);
        let (file, shows_column) = (visible(self.file()), excerpt.column() == self.column());
        let mark = AnnotationKind::Primary.span(excerpt.marked);
        let snippet = Snippet::source(excerpt.shown).line_start(excerpt.first_line).fold(false).annotation(mark);
        let report = match shows_column {
            true => title.element(snippet.path(file)),
            false => {
                let place = Origin::path(file).line(self.line()).char_column(self.column());
                title.element(place).element(snippet)
            }
        };
        let report = report.elements(self.help().map(|help| Level::HELP.message(visible(help))));
        style.renderer().render(&[report]) + "\n\n"
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

/// The lines around the place, or a part of a long line.
struct Excerpt {
    shown: String,
    /// From 1.
    first_line: usize,
    /// In `shown`.
    marked: Range<usize>,
}

impl Excerpt {
    fn of(diagnostic: &Diagnostic, text: &str) -> Self {
        let (span, line) = (diagnostic.span(), diagnostic.line());
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
        let begin = part(shown.start..marked.start).len();
        let end = begin + part(marked).len();
        Excerpt { marked: begin..end, shown: part(shown), first_line }
    }

    /// The column at which the mark begins in what is shown, from 1.
    fn column(&self) -> usize {
        let before = &self.shown[..self.marked.start];
        before[before.rfind('\n').map_or(0, |k| k + 1)..].chars().count() + 1
    }
}
