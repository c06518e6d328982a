//! From text to XML. The parser's errors are reported at their places, in mozzi's wording. Unexpanded xacro is refused.

use crate::report::finding::{Finding, Findings};
use crate::text::dialect::Dialect;
use crate::text::mend;
use crate::text::scan::{Unfinished, scan};
use crate::text::source::Source;
use crate::text::xacro;
use crate::urdf::vocabulary::shown;
use roxmltree::{Document, Error, ParsingOptions};
use std::ops::Range;

/// More nodes (elements, texts, comments) are refused: a parsed node takes about ten times the memory of its text.
const MOST_NODES: u32 = 2_000_000;

/// The text to parse: harmless slips are corrected and reported.
pub(crate) fn mended(source: Source, dialect: Dialect, findings: &mut Findings) -> Source {
    let (source, late) = mend::declaration(source);
    let (source, undeclared) = mend::prefixes(source, dialect);
    late.into_iter().chain(undeclared).for_each(|finding| findings.add(finding));
    source
}

/// The first undeclared prefix, and its place in the text.
pub(crate) fn undeclared(source: &Source) -> Option<(String, Range<usize>)> {
    scan(&source.text).ok()?;
    let Err(Error::UnknownNamespace(prefix, pos)) = document(&source.text) else { return None };
    let at = source.offset(pos.row as usize, pos.col as usize);
    let span = at..at + prefix.len();
    Some((prefix, span))
}

fn document(text: &str) -> Result<Document<'_>, Error> {
    Document::parse_with_options(text, ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() })
}

/// The parsed text, or the first error of its syntax.
pub(crate) fn parse(source: &Source, dialect: Dialect) -> Result<Document<'_>, Finding> {
    if source.text.trim().is_empty() {
        let message = format!("the file is empty, expected a <{}>", dialect.root());
        return Err(Finding::error("empty", source.place(0..0), message));
    }
    parse_text(source, dialect).map_err(|finding| Finding { span: source.place(finding.span.clone()), ..finding })
}

/// As [`parse`], with places counted from the beginning of this text.
fn parse_text(source: &Source, dialect: Dialect) -> Result<Document<'_>, Finding> {
    let unfinished = scan(&source.text)?;
    let document = document(&source.text).map_err(|error| explain(source, dialect, error, unfinished))?;
    match xacro::refuse(&document, &source.name, dialect) {
        Some(finding) => Err(finding),
        None => Ok(document),
    }
}

fn explain(source: &Source, dialect: Dialect, error: Error, unfinished: Option<Unfinished>) -> Finding {
    let at = |pos: roxmltree::TextPos| {
        let start = source.offset(pos.row as usize, pos.col as usize);
        let rest = &source.text[start.min(source.text.len())..];
        let first = rest.chars().next().filter(|c| *c != '\n').map_or(0, char::len_utf8);
        start..start + first
    };
    let syntax = |span, message: String| Finding::error("syntax", span, message);
    let is_end = matches!(error, Error::UnclosedRootNode | Error::UnexpectedEndOfStream)
        || at(error.pos()).start >= source.text.trim_end().len();
    match unfinished {
        Some(Unfinished::Piece(span, what))
            if is_end || matches!(error, Error::InvalidString(..)) && at(error.pos()).start >= span.start =>
        {
            return syntax(span, format!("the file ends inside {what} that opens here")).help("is the file complete?");
        }
        Some(Unfinished::Element(span)) if is_end => {
            let message = format!("the file ends before <{}> is closed", shown(&source.text[span.clone()]));
            return syntax(span, message).help("is the file complete?");
        }
        _ => {}
    }
    match error {
        Error::NoRootNode => {
            let message = format!("the file has no element, expected a <{}>", dialect.root());
            syntax(0..0, message).help("check that this is the right file")
        }
        Error::UnexpectedCloseTag(expected, found, pos) => {
            let (expected, found) = (shown(&expected), shown(&found));
            syntax(at(pos), format!("</{found}> closes <{expected}>, expected </{expected}>"))
                .help(format!("is a </{expected}> missing before it, or a `/` in <{expected} …/>?"))
        }
        Error::UnknownNamespace(prefix, pos) => {
            let prefix = shown(&prefix);
            let (root, space) = (dialect.root(), if prefix == "xacro" { "http://www.ros.org/wiki/xacro" } else { "…" });
            syntax(at(pos), format!("the prefix `{prefix}:` is not declared"))
                .help(format!("declare it on the root: <{root} xmlns:{prefix}=\"{space}\">"))
        }
        Error::DuplicatedAttribute(name, pos) => {
            syntax(at(pos), format!("the attribute `{}` occurs twice on one element", shown(&name)))
                .help("keep one of them")
        }
        Error::UnknownEntityReference(name, pos) => {
            let message = format!("the entity `&{};` is unknown; entities are not expanded", shown(&name));
            syntax(at(pos), message).help("write the character itself; `&` is written `&amp;`")
        }
        Error::MalformedEntityReference(pos) => {
            syntax(at(pos), "`&` begins no entity here".to_string()).help("`&` is written `&amp;`")
        }
        Error::InvalidAttributeValue(pos) | Error::InvalidChar(b'"' | b'\'', b'<', pos) => {
            syntax(at(pos), "`<` is inside an attribute's value".to_string())
                .help("is a closing quote missing before it? `<` itself is written `&lt;`")
        }
        Error::UnknownToken(pos) => {
            let rest = &source.text[at(pos).start..];
            let word = shown(rest.split(['\n', '>']).next().unwrap_or_default().trim());
            match rest.starts_with('<') {
                true => syntax(at(pos), "a second root element begins here, expected the file's end".to_string())
                    .help("a file contains one robot; check for an extra closing tag before it"),
                false => {
                    let help = match word.contains(',') {
                        true => "is it a table? A robot's file is given before it",
                        false => "is it a URDF? It begins with <robot name=\"…\">",
                    };
                    syntax(at(pos), format!("found `{word}`, expected an element")).help(help)
                }
            }
        }
        Error::InvalidChar(expected, found, pos) => {
            syntax(at(pos), format!("expected `{}`, found `{}`", expected as char, found as char))
        }
        Error::InvalidChar2(expected, found, pos) => {
            let help = "put values in quotes: <mass value=\"1\"/>";
            let error = syntax(at(pos), format!("expected {expected}, found `{}`", found as char));
            if expected == "a quote" { error.help(help) } else { error }
        }
        Error::NodesLimitReached => {
            Finding::error("too_large", 0..0, format!("the file has more than {MOST_NODES} elements and texts"))
        }
        Error::DtdDetected => Finding::error("document_type", 0..0, "the file has a document type"),
        other => {
            // the parser's own message, without the position at its end
            let (pos, text) = (other.pos(), other.to_string());
            let place = format!(" at {pos}");
            syntax(at(pos), text.replace(&place, ""))
        }
    }
}
