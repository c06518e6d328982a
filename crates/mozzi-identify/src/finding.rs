//! What was noticed in a log or in a fit, and did not stop it.

use core::fmt;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Worth knowing.
    Note,
    /// The result may be wrong because of it.
    Warning,
}

/// One remark about a log or a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// A word for programs, such as `repeated_rows`.
    pub code: &'static str,
    /// How much it matters.
    pub level: Level,
    /// A sentence: what, where, how much, and what helps.
    pub text: String,
}

impl Finding {
    /// Worth knowing.
    pub fn note(code: &'static str, text: impl Into<String>) -> Self {
        Finding { code, level: Level::Note, text: text.into() }
    }

    /// The result may be wrong because of it.
    pub fn warning(code: &'static str, text: impl Into<String>) -> Self {
        Finding { code, level: Level::Warning, text: text.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = if self.level == Level::Warning { "warning" } else { "note" };
        write!(f, "{level}: {} ({})", self.text, self.code)
    }
}
