//! The text of a file, and the line and column of its bytes.

use std::ops::Range;
use std::sync::Arc;

/// A named text, cheap to clone: each diagnostic carries it, to show the place.
#[derive(Clone)]
pub(crate) struct Source {
    pub name: Arc<str>,
    /// The text that is parsed.
    pub text: Arc<str>,
    /// The place of its first byte among all texts of a robot.
    pub base: usize,
    /// The text of the file, if the parsed text differs.
    original: Option<Arc<str>>,
    /// The place and length of an insertion into the text of the file.
    inserted: (usize, usize),
    /// Whether diagnostics may show lines of it.
    pub is_shown: bool,
    /// A part of the file, with names changed.
    pub is_attached: bool,
    /// The expansion that produced the text, if it is not a file's: its places are in other files.
    pub expansion: Option<Arc<mozzi_xacro::Expansion>>,
}

/// A place in a text: line and column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    pub line: usize,
    pub column: usize,
}

impl Source {
    pub fn new(name: &str, text: &str) -> Self {
        let (name, text, original, inserted) = (name.into(), text.into(), None, (0, 0));
        Source { name, text, base: 0, original, inserted, is_shown: true, is_attached: false, expansion: None }
    }

    /// Replaces the parsed text by one in which all places are the same.
    pub fn replaced(self, text: String) -> Self {
        let original = self.original.or(Some(self.text));
        Source { text: text.into(), original, ..self }
    }

    /// Inserts `what` into the parsed text. All insertions are at one place.
    pub fn with_insertion(&self, at: usize, what: &str) -> Self {
        let text = format!("{}{what}{}", &self.text[..at], &self.text[at..]);
        let inserted = (at, self.inserted.1 + what.len());
        Source { inserted, ..self.clone().replaced(text) }
    }

    /// The file as it is, for excerpts.
    pub fn file(&self) -> Source {
        let text = self.original.clone().unwrap_or_else(|| self.text.clone());
        Source { text, original: None, inserted: (0, 0), ..self.clone() }
    }

    /// Converts a place in the file to its place in the parsed text.
    pub fn in_text(&self, span: Range<usize>) -> Range<usize> {
        let (at, length) = self.inserted;
        let place = |k: usize| if k >= at { k + length } else { k };
        place(span.start)..place(span.end)
    }

    /// Converts a place in the parsed text to its place in the file.
    pub fn in_file(&self, span: Range<usize>) -> Range<usize> {
        let (at, length) = self.inserted;
        let place = |k: usize| if k > at { k.saturating_sub(length).max(at) } else { k };
        place(span.start)..place(span.end)
    }

    /// Sets the place of its first byte among all texts.
    pub fn at(self, base: usize) -> Self {
        Source { base, ..self }
    }

    /// For a file that a model names: it may be any file of this machine, so diagnostics must not show its lines.
    pub fn hidden(self) -> Self {
        Source { is_shown: false, ..self }
    }

    /// For a part of a file, with names changed.
    pub fn attached(self) -> Self {
        Source { is_attached: true, ..self }
    }

    /// Converts a place in this text to its place among all texts.
    pub fn place(&self, span: Range<usize>) -> Range<usize> {
        span.start + self.base..span.end + self.base
    }

    /// The byte of a line and column, as the XML parser counts them; the end of the text if it is shorter.
    pub fn offset(&self, line: usize, column: usize) -> usize {
        let start = match line.checked_sub(2) {
            None => 0,
            Some(k) => self.text.match_indices('\n').nth(k).map_or(self.text.len(), |(at, _)| at + 1),
        };
        let rest = &self.text[start..];
        start + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(at, _)| at)
    }

    /// The span cut to the text, on boundaries of characters.
    pub fn clamp(&self, span: Range<usize>) -> Range<usize> {
        let start = self.text.floor_char_boundary(span.start);
        start..self.text.floor_char_boundary(span.end).max(start)
    }
}

/// Finds positions of ascending offsets in one pass over the text.
pub(crate) struct Walker<'t> {
    text: &'t str,
    at: usize,
    position: Position,
}

impl<'t> Walker<'t> {
    pub fn new(text: &'t str) -> Self {
        Walker { text, at: 0, position: Position { line: 1, column: 1 } }
    }

    /// The position of a byte at a character boundary. Calls must be in ascending order.
    pub fn advance(&mut self, offset: usize) -> Position {
        let passed = self.text.get(self.at..offset).unwrap_or_default();
        match passed.rfind('\n') {
            Some(last) => {
                self.position.line += passed.matches('\n').count();
                self.position.column = 1 + passed[last + 1..].chars().count();
            }
            None => self.position.column += passed.chars().count(),
        }
        self.at = self.at.max(offset);
        self.position
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_characters() {
        let source = Source::new("a", "äx\r\n öy\n");
        let mut walker = Walker::new(&source.text);
        assert_eq!(walker.advance(2), Position { line: 1, column: 2 });
        let y = source.text.find('y').expect("a y");
        assert_eq!(walker.advance(y), Position { line: 2, column: 3 });
        assert_eq!(source.offset(2, 3), y);
        assert_eq!(source.offset(9, 1), source.text.len());
        assert_eq!(walker.advance(source.text.len()), Position { line: 3, column: 1 });
    }
}
