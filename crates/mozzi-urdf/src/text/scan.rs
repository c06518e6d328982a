//! A quick scan of the whole text before the parser. It bounds nesting, attributes, namespaces and document types, and
//! so the parser's memory and time. It checks nothing else: malformed text is left to the parser.

use crate::report::finding::Finding;
use std::ops::Range;

/// Deeper nesting is refused.
pub(crate) const MOST_DEPTH: usize = 256;
/// More attributes on one element are refused.
pub(crate) const MOST_ATTRIBUTES: usize = 256;
/// More namespaces in scope at one place are refused.
pub(crate) const MOST_NAMESPACES: usize = 64;

/// More declarations of namespaces are refused.
pub(crate) const MOST_DECLARATIONS: usize = 4096;

/// An element that was opened and not yet closed.
struct Open {
    name: Range<usize>,
    namespaces: usize,
}

/// The construct that is still open at the end of the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Unfinished {
    /// A construct that is not an element, and its name: "a comment".
    Piece(Range<usize>, &'static str),
    /// The innermost element, by the place of its name.
    Element(Range<usize>),
}

/// The construct that is never closed, if there is one.
pub(crate) fn scan(text: &str) -> Result<Option<Unfinished>, Finding> {
    let mut open: Vec<Open> = Vec::new();
    let (mut at, mut declarations) = (0, 0);
    while let Some(start) = text[at..].find('<').map(|k| at + k) {
        let rest = &text[start..];
        let (end, what) = if rest.starts_with("<!--") {
            (after(text, start + 4, "-->"), "a comment")
        } else if rest.starts_with("<![CDATA[") {
            (after(text, start, "]]>"), "a CDATA section")
        } else if rest.starts_with("<?") {
            (after(text, start, "?>"), "a declaration")
        } else if let Some(declaration) = rest.strip_prefix("<!") {
            if declaration.get(..7).is_some_and(|word| word.eq_ignore_ascii_case("doctype")) {
                let message = "the file has a document type (<!DOCTYPE>), expected none: entities are not expanded";
                return Err(Finding::error("document_type", start..start + 9, message).help("remove the declaration"));
            }
            (after(text, start, ">"), "a declaration")
        } else if rest.starts_with("</") {
            open.pop();
            (after(text, start, ">"), "a tag")
        } else {
            let tag = Tag::read(text, start);
            let namespaces = tag.namespaces + open.last().map_or(0, |parent| parent.namespaces);
            declarations += tag.namespaces;
            tag.check(namespaces, declarations, open.len() + 1)?;
            if !tag.closed {
                open.push(Open { name: tag.name, namespaces });
            }
            (tag.end, "a tag")
        };
        match end {
            Some(end) => at = end,
            None => return Ok(Some(Unfinished::Piece(start..start + 1, what))),
        }
    }
    Ok(open.pop().map(|element| Unfinished::Element(element.name)))
}

fn after(text: &str, from: usize, pattern: &str) -> Option<usize> {
    text.get(from..)?.find(pattern).map(|k| from + k + pattern.len())
}

/// The counts of a start tag.
struct Tag {
    name: Range<usize>,
    attributes: usize,
    namespaces: usize,
    closed: bool,
    /// None if the text ends in it.
    end: Option<usize>,
}

impl Tag {
    /// Reads the tag that opens at `start`.
    fn read(text: &str, start: usize) -> Tag {
        let bytes = text.as_bytes();
        let name_end = bytes[start + 1..]
            .iter()
            .position(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'/' | b'>'))
            .map_or(text.len(), |k| start + 1 + k);
        let mut tag = Tag { name: start + 1..name_end, attributes: 0, namespaces: 0, closed: false, end: None };
        let mut at = name_end;
        while let Some(&byte) = bytes.get(at) {
            at += 1;
            match byte {
                b'>' => {
                    tag.closed = bytes[at - 2] == b'/';
                    tag.end = Some(at);
                    break;
                }
                b'"' | b'\'' => match bytes[at..].iter().position(|&b| b == byte) {
                    Some(k) => at += k + 1,
                    None => break,
                },
                b'=' => tag.attributes += 1,
                b'x' if bytes[at..].starts_with(b"mlns") => tag.namespaces += 1,
                _ => {}
            }
        }
        tag
    }

    fn check(&self, namespaces: usize, declarations: usize, depth: usize) -> Result<(), Finding> {
        let error = |code, what: &str, found: usize, most: usize| {
            Err(Finding::error(code, self.name.clone(), format!("{found} {what}, expected at most {most}")))
        };
        if depth > MOST_DEPTH {
            return error("too_deep", "nested elements", depth, MOST_DEPTH);
        }
        if self.attributes > MOST_ATTRIBUTES {
            return error("too_many_attributes", "attributes on this element", self.attributes, MOST_ATTRIBUTES);
        }
        if namespaces > MOST_NAMESPACES {
            return error("too_many_namespaces", "namespaces in scope", namespaces, MOST_NAMESPACES);
        }
        if declarations > MOST_DECLARATIONS {
            let what = "namespaces declared up to here";
            return error("too_many_namespaces", what, declarations, MOST_DECLARATIONS);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_is_never_closed() {
        let unfinished = |text: &str| scan(text).expect("within the bounds");
        assert_eq!(unfinished("<a><b x='>'/><!-- <c> --></a>"), None);
        assert_eq!(unfinished("<a><b x='1'><![CDATA[</b>]]>"), Some(Unfinished::Element(4..5)));
        assert_eq!(unfinished("<a><b"), Some(Unfinished::Piece(3..4, "a tag")));
        assert_eq!(unfinished("<a b='"), Some(Unfinished::Piece(0..1, "a tag")));
        assert_eq!(unfinished("<a><!-- <b>"), Some(Unfinished::Piece(3..4, "a comment")));
        assert_eq!(unfinished(""), None);
    }

    #[test]
    fn bounds() {
        let code = |text: &str| scan(text).expect_err("refused").code;
        assert_eq!(code(&"<a>".repeat(257)), "too_deep");
        assert!(scan(&"<a>".repeat(256)).is_ok());
        assert!(scan(&"<a/>".repeat(100_000)).is_ok());
        assert_eq!(code(&format!("<a {}>", "b='' ".repeat(257))), "too_many_attributes");
        assert_eq!(code(&"<a xmlns:b='c'>".repeat(65)), "too_many_namespaces");
        assert_eq!(code(&"<a xmlns:b='c'/>".repeat(4097)), "too_many_namespaces");
        assert_eq!(code("<?xml version='1.0'?><!DOCTYPE a>"), "document_type");
    }
}
