//! The report for people: the line of the file, a caret under the value, and how to mend it.

use crate::diagnostic::Diagnostic;
use crate::error::{LoadError, PRINTED};
use miette::{GraphicalReportHandler, GraphicalTheme};
use mozzi::model::Severity;
use std::fmt::Write;

/// How a report is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// ASCII alone, for files and tests.
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
    /// The report for people.
    pub fn pretty(&self, style: Style) -> String {
        let mut text = String::new();
        match style.handler().render_report(&mut text, self) {
            Ok(()) => text,
            Err(_) => self.to_string(),
        }
    }
}

impl LoadError {
    /// The report for people: each error with its place, after the warnings beside them.
    pub fn pretty(&self, style: Style) -> String {
        let mut text = String::new();
        let warnings = self.diagnostics().iter().filter(|diagnostic| diagnostic.severity() == Severity::Warning);
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
