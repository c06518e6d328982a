//! Findings at their lines and columns.

use super::diagnostic::Diagnostic;
use super::finding::Findings;
use crate::text::dialect::Dialect;
use crate::text::expansion;
use crate::text::source::{Source, Walker};

/// All findings with their places, in the order of the file.
pub(crate) struct Placed {
    pub diagnostics: Vec<Diagnostic>,
    pub errors: usize,
    /// Errors were found and not kept.
    pub is_cut: bool,
}

impl Placed {
    /// Looks up every place in one pass over the texts, which follow one another.
    pub fn of(mut findings: Findings, sources: &[Source], dialect: Dialect) -> Self {
        let (is_cut, errors) = (findings.is_full(), findings.errors());
        findings.kept.sort_by_key(|finding| finding.span.start);
        let (mut diagnostics, mut kept) = (Vec::new(), findings.kept.into_iter().peekable());
        for (i, source) in sources.iter().enumerate() {
            let end = sources.get(i + 1).map_or(usize::MAX, |next| next.base);
            let file = source.file();
            let mut walker = Walker::new(&file.text);
            while let Some(mut finding) = kept.next_if(|finding| finding.span.start < end) {
                finding = if source.is_shown { finding } else { finding.without_content() };
                let local = |place: usize| place.saturating_sub(source.base);
                let span = source.in_file(local(finding.span.start)..local(finding.span.end));
                if let Some(expansion) = &source.expansion {
                    diagnostics.push(expansion::placed(expansion, finding, span, dialect));
                    continue;
                }
                finding.span = file.clamp(span);
                let position = walker.advance(finding.span.start);
                diagnostics.push(Diagnostic::new(finding, position, file.clone(), dialect));
            }
        }
        Placed { diagnostics, errors, is_cut }
    }
}
