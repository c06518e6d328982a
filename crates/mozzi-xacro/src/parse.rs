//! Parses a text into a tree. roxmltree validates the text; the code here splits it into elements with their places,
//! because roxmltree keeps no prefixes and joins CDATA with text.

use crate::bounds::{Budget, MOST_BYTES, MOST_ELEMENT_DEPTH};
use crate::document::{Attribute, Content, Document, Id};
use crate::fault::{Fault, Result};
use crate::place::Place;
use roxmltree::ParsingOptions;
use std::ops::Range;

/// The most attributes of one element.
const MOST_ATTRIBUTES: usize = 256;
/// The most declarations of namespaces.
const MOST_NAMESPACES: usize = 1024;
/// The most elements and texts of one file.
const MOST_NODES: u32 = 1_000_000;

/// The top-level nodes, and the index of the root element among them.
pub(crate) struct Parsed {
    pub top: Vec<Id>,
    pub root: Id,
}

/// The error in a text that is not XML.
pub(crate) const NOT_XML: &str = "not XML";

pub(crate) fn parse(text: &str, file: u32, document: &mut Document, budget: &Budget) -> Result<Parsed> {
    if text.len() > MOST_BYTES {
        return Err(Fault::new(format!("the file has {} bytes, expected at most {MOST_BYTES}", text.len())));
    }
    budget.spend(1 + text.len() as u64 / 64)?;
    let mut reader = Reader { text, file, document, budget, open: Vec::new(), top: Vec::new(), namespaces: 0 };
    reader.read()?;
    let (top, open) = (reader.top, reader.open.len());
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    if let Err(error) = roxmltree::Document::parse_with_options(text, options) {
        return Err(not_xml(text, file, &error));
    }
    let root = top.iter().find(|id| document.name(**id).is_some()).copied();
    match root {
        Some(root) if open == 0 => Ok(Parsed { top, root }),
        _ => Err(placed(file, 0..0, format!("{NOT_XML}: the file has no complete element"))),
    }
}

fn placed(file: u32, span: Range<usize>, message: String) -> Box<Fault> {
    Box::new(Fault { place: Some(Place::new(file, span)), ..*Fault::new(message) })
}

fn not_xml(text: &str, file: u32, error: &roxmltree::Error) -> Box<Fault> {
    let (position, message) = (error.pos(), error.to_string());
    let line = position.row.saturating_sub(1) as usize;
    let start = if line == 0 { 0 } else { text.match_indices('\n').nth(line - 1).map_or(text.len(), |(at, _)| at + 1) };
    let column = (position.col as usize).saturating_sub(1);
    let at = start + text[start..].char_indices().nth(column).map_or(text.len() - start, |(at, _)| at);
    let message = message.replace(&format!(" at {position}"), "");
    placed(file, at..at, format!("{NOT_XML}: {message}"))
}

struct Reader<'r> {
    text: &'r str,
    file: u32,
    document: &'r mut Document,
    budget: &'r Budget,
    open: Vec<Id>,
    top: Vec<Id>,
    namespaces: usize,
}

impl Reader<'_> {
    /// Malformed text gives some tree: the text is refused afterwards.
    fn read(&mut self) -> Result<()> {
        let mut at = 0;
        while at < self.text.len() {
            let rest = &self.text[at..];
            let end =
                |mark: &str, from: usize| rest.get(from..).and_then(|r| r.find(mark)).map_or(rest.len(), |k| from + k);
            if rest.starts_with("<!--") {
                let close = end("-->", 4);
                self.add(Content::Comment(newlines(&rest[4.min(close)..close]).into()), at..at + close)?;
                at += (close + 3).min(rest.len());
            } else if rest.starts_with("<![CDATA[") {
                let close = end("]]>", 9);
                self.add(Content::Data(newlines(&rest[9..close]).into()), at + 9..at + close)?;
                at += (close + 3).min(rest.len());
            } else if rest.starts_with("<?") {
                let close = end("?>", 2);
                let inner = &rest[2..close];
                // the XML declaration is written again
                if inner.split_ascii_whitespace().next() != Some("xml") {
                    self.add(Content::Instruction(newlines(inner).into()), at..at + close)?;
                }
                at += (close + 2).min(rest.len());
            } else if rest.starts_with("</") {
                self.open.pop();
                at += (end(">", 2) + 1).min(rest.len());
            } else if rest.starts_with("<!") {
                at += (end(">", 2) + 1).min(rest.len());
            } else if rest.starts_with('<') {
                at = self.element(at)?;
            } else {
                let close = end("<", 0);
                if !self.open.is_empty() {
                    self.add(Content::Text(decoded(&rest[..close], false).into()), at..at + close)?;
                }
                at += close;
            }
        }
        Ok(())
    }

    fn add(&mut self, content: Content, span: Range<usize>) -> Result<Id> {
        self.budget.spend(1)?;
        let id = self.document.add(content, Place::new(self.file, span));
        match self.open.last() {
            Some(parent) => self.document.append(*parent, id),
            None => self.top.push(id),
        }
        Ok(id)
    }

    /// Parses the element whose tag begins here; returns the tag's end.
    fn element(&mut self, start: usize) -> Result<usize> {
        let bytes = self.text.as_bytes();
        let ends_name = |b: &u8| b.is_ascii_whitespace() || matches!(b, b'/' | b'>' | b'=' | b'<' | b'"' | b'\'');
        let name_end = |from: usize| bytes[from..].iter().position(ends_name).map_or(bytes.len(), |k| from + k);
        let span = start + 1..name_end(start + 1);
        let (name, mut attributes, mut at) = (self.text[span.clone()].into(), Vec::new(), span.end);
        let refused = |what: &str| Err(placed(self.file, span.clone(), what.to_string()));
        let is_closed = loop {
            match bytes.get(at) {
                None => break true,
                Some(b'>') => {
                    at += 1;
                    break bytes[at - 2] == b'/';
                }
                Some(b) if ends_name(b) => at += 1,
                Some(_) => {
                    let key = at..name_end(at);
                    let equals = key.end + count_space(&bytes[key.end..]);
                    let quote = equals + 1 + count_space(bytes.get(equals + 1..).unwrap_or_default());
                    let mark = bytes.get(quote).copied().filter(|b| matches!(b, b'"' | b'\''));
                    let (Some(b'='), Some(mark)) = (bytes.get(equals), mark) else {
                        at = key.end.max(at + 1);
                        continue;
                    };
                    let value = quote + 1
                        ..bytes[quote + 1..].iter().position(|b| *b == mark).map_or(bytes.len(), |k| quote + 1 + k);
                    let (name, raw) = (&self.text[key.clone()], &self.text[value.clone()]);
                    self.namespaces += usize::from(name.starts_with("xmlns"));
                    let place = Place::new(self.file, value.clone());
                    let name_start = key.start as u32;
                    attributes.push(Attribute {
                        name: name.into(),
                        value: decoded(raw, true).into(),
                        name_start,
                        place,
                    });
                    at = (value.end + 1).min(bytes.len());
                }
            }
        };
        if attributes.len() > MOST_ATTRIBUTES {
            return refused(&format!(
                "{} attributes on this element, expected at most {MOST_ATTRIBUTES}",
                attributes.len()
            ));
        }
        if self.namespaces > MOST_NAMESPACES {
            return refused(&format!("more than {MOST_NAMESPACES} namespaces declared up to here"));
        }
        if self.open.len() >= MOST_ELEMENT_DEPTH {
            return refused(&format!("more than {MOST_ELEMENT_DEPTH} nested elements"));
        }
        self.budget.spend(attributes.len() as u64)?;
        let id = self.add(Content::Element { name, attributes }, span)?;
        if !is_closed {
            self.open.push(id);
        }
        Ok(at)
    }
}

fn count_space(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|b| b.is_ascii_whitespace()).count()
}

/// Normalizes line ends as XML requires.
fn newlines(text: &str) -> String {
    if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n") } else { text.to_string() }
}

/// Text with its entities replaced; in attributes, white space becomes spaces.
fn decoded(raw: &str, is_attribute: bool) -> String {
    let is_plain = |b: u8| b != b'&' && b != b'\r' && !(is_attribute && matches!(b, b'\n' | b'\t'));
    if raw.bytes().all(is_plain) {
        return raw.to_string();
    }
    let text = newlines(raw);
    let text = if is_attribute { text.replace(['\n', '\t'], " ") } else { text };
    let (mut out, mut rest) = (String::with_capacity(text.len()), text.as_str());
    while let Some(at) = rest.find('&') {
        out.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        let Some((entity, after)) = rest.split_once(';') else { continue };
        let code = |digits: &str, radix| u32::from_str_radix(digits, radix).ok().and_then(char::from_u32);
        let c = match entity {
            "lt" => Some('<'),
            "gt" => Some('>'),
            "amp" => Some('&'),
            "quot" => Some('"'),
            "apos" => Some('\''),
            _ => match entity.strip_prefix("#x") {
                Some(digits) => code(digits, 16),
                None => entity.strip_prefix('#').and_then(|digits| code(digits, 10)),
            },
        };
        out.extend(c);
        rest = after;
    }
    out + rest
}
