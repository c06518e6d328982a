//! Findings of a reader, before their line and column are computed.

use mozzi::model::Severity;
use std::ops::Range;

/// More are counted, not kept.
pub(crate) const MOST_FINDINGS: usize = 1000;

/// The topic of an attribute or element that mozzi does not use. It is counted, without a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Topic {
    Looks,
    Actuators,
    Settings,
    Idle,
}

/// A finding at a span of the text.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub severity: Severity,
    pub code: &'static str,
    pub span: Range<usize>,
    pub message: String,
    pub help: Option<String>,
    /// For unused content: what it concerns.
    pub topic: Option<Topic>,
}

impl Finding {
    pub fn error(code: &'static str, span: Range<usize>, message: impl Into<String>) -> Self {
        Finding { severity: Severity::Error, code, span, message: message.into(), help: None, topic: None }
    }

    pub fn warning(code: &'static str, span: Range<usize>, message: impl Into<String>) -> Self {
        Finding { severity: Severity::Warning, ..Finding::error(code, span, message) }
    }

    /// An attribute or element that is not used.
    pub fn unused(topic: Topic, code: &'static str, span: Range<usize>, message: impl Into<String>) -> Self {
        Finding { topic: Some(topic), ..Finding::warning(code, span, message) }
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Without words of the text, for a file whose content must not be shown. Findings about an `<include>` or an
    /// encoding have none.
    pub fn without_content(self) -> Self {
        let says_nothing = ["include", "repeated_include", "too_large", "not_utf8", "empty"];
        if says_nothing.contains(&self.code) {
            return self;
        }
        let message = "this included file has content that MJCF does not define here; it is not shown".to_string();
        let help = "if it is a part of the model, make <mujocoinclude> its root: then the content is shown";
        Finding { message, help: Some(help.to_string()), ..self }
    }

    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help;
        self
    }
}

/// All findings, the first thousand of either severity.
#[derive(Default)]
pub(crate) struct Findings {
    pub(super) kept: Vec<Finding>,
    errors: usize,
    warnings: usize,
}

impl Findings {
    pub fn add(&mut self, finding: Finding) {
        let count = match finding.severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        if *count <= MOST_FINDINGS {
            self.kept.push(finding);
        }
    }

    pub fn error(&mut self, code: &'static str, span: Range<usize>, message: impl Into<String>) {
        self.add(Finding::error(code, span, message));
    }

    /// The number of errors so far.
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// True if there are enough errors to stop reading.
    pub fn is_full(&self) -> bool {
        self.errors > MOST_FINDINGS
    }

    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// All of them, shifted by some bytes.
    pub fn moved(self, by: usize) -> impl Iterator<Item = Finding> {
        let moved = move |span: Range<usize>| span.start + by..span.end + by;
        self.kept.into_iter().map(move |finding| Finding { span: moved(finding.span), ..finding })
    }
}
