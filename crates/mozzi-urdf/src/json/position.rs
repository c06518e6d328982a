//! The place of an entry in a JSON text. The text was parsed before, so it is valid.

use super::file::Step;

/// Line and column, from 1, of the entry at a path: of its key, or of its value in a list. If an entry does not exist,
/// those of the value in which it is missing.
pub fn find(text: &str, path: &[Step]) -> (usize, usize) {
    let mut scan = Scan { bytes: text.as_bytes(), at: 0 };
    scan.skip(|byte| byte.is_ascii_whitespace() || !byte.is_ascii()); // a byte order mark
    let mut found = scan.at;
    for step in path {
        match scan.enter(*step) {
            Some(place) => found = place,
            None => break,
        }
    }
    let before = &text[..found];
    let start_of_line = before.rfind('\n').map_or(0, |newline| newline + 1);
    let column = before[start_of_line..].trim_start_matches('\u{feff}').chars().count() + 1;
    (before.matches('\n').count() + 1, column)
}

/// Where a value of a file begins, and where its entries do: line and column, from 1. The place of a map's entry is
/// that of its key.
#[derive(Debug, Default)]
pub struct Place {
    pub at: (usize, usize),
    /// The keys of a map's entries.
    pub keys: Vec<String>,
    pub entries: Vec<Place>,
}

impl Place {
    /// As [`find`].
    pub fn find(&self, path: &[Step]) -> (usize, usize) {
        let mut place = self;
        for step in path {
            let index = match step {
                Step::Key(key) => place.keys.iter().position(|known| known == key),
                Step::Index(index) if place.keys.is_empty() => Some(*index),
                Step::Index(_) => None,
            };
            match index.and_then(|index| place.entries.get(index)) {
                Some(entry) => place = entry,
                None => break,
            }
        }
        place.at
    }
}

struct Scan<'t> {
    bytes: &'t [u8],
    /// Called at the first byte of a value, outside [`Self::value`].
    at: usize,
}

impl Scan<'_> {
    fn byte(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or_default()
    }

    fn skip(&mut self, is_skipped: impl Fn(u8) -> bool) {
        while self.at < self.bytes.len() && is_skipped(self.byte()) {
            self.at += 1;
        }
    }

    fn space(&mut self) {
        self.skip(|byte| byte.is_ascii_whitespace());
    }

    /// Moves from a value to an entry of it; returns the start of the entry. Does not move if there is none.
    fn enter(&mut self, step: Step) -> Option<usize> {
        let start = self.at;
        let (open, close) = match step {
            Step::Key(_) => (b'{', b'}'),
            Step::Index(_) => (b'[', b']'),
        };
        if self.byte() != open {
            return None;
        }
        self.at += 1;
        for index in 0.. {
            self.skip(|byte| byte.is_ascii_whitespace() || byte == b',');
            if self.byte() == close || self.at >= self.bytes.len() {
                break;
            }
            let place = self.at;
            let is_it = match step {
                Step::Key(key) => self.key() == key,
                Step::Index(wanted) => index == wanted,
            };
            if is_it {
                return Some(place);
            }
            self.value();
        }
        self.at = start;
        None
    }

    /// Skips a key and its colon.
    fn key(&mut self) -> String {
        let start = self.at;
        self.string();
        let key = serde_json::from_slice(&self.bytes[start..self.at]).unwrap_or_default();
        self.skip(|byte| byte.is_ascii_whitespace() || byte == b':');
        key
    }

    /// Skips a string.
    fn string(&mut self) {
        self.at += 1;
        while self.at < self.bytes.len() && self.byte() != b'"' {
            self.at += if self.byte() == b'\\' { 2 } else { 1 };
        }
        self.at = (self.at + 1).min(self.bytes.len());
    }

    /// Skips a value.
    fn value(&mut self) {
        let mut depth = 0_usize;
        loop {
            self.space();
            match self.byte() {
                b'"' => self.string(),
                b'{' | b'[' => {
                    depth += 1;
                    self.at += 1;
                }
                b'}' | b']' => {
                    depth = depth.saturating_sub(1);
                    self.at += 1;
                }
                b',' | b':' => self.at += 1,
                _ => self.skip(|byte| !byte.is_ascii_whitespace() && !b",:]}".contains(&byte)),
            }
            if depth == 0 || self.at >= self.bytes.len() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Step::{Index, Key};

    #[test]
    fn each_entry_is_found() {
        let text = "\u{feff}{\"a\\\"]\": [1, {\"b\" : -2e3}],\n  \"ü\": true, \"c\":\n [[], [\"}\", {}], 7]\n}";
        let at = |path: &[Step]| find(text, path);
        assert_eq!(at(&[]), (1, 1));
        assert_eq!(at(&[Key("a\"]")]), (1, 2));
        assert_eq!(at(&[Key("a\"]"), Index(1), Key("b")]), (1, 15));
        assert_eq!(at(&[Key("ü")]), (2, 3));
        assert_eq!(at(&[Key("c")]), (2, 14));
        assert_eq!(at(&[Key("c"), Index(1), Index(1)]), (3, 13));
        assert_eq!(at(&[Key("c"), Index(2)]), (3, 18));
        assert_eq!(at(&[Key("c"), Index(9)]), (2, 14), "the list that lacks it");
        assert_eq!(at(&[Key("ü"), Key("x"), Key("y")]), (2, 3));
    }
}
