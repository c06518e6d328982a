//! Corrects slips of XML that other readers of robots accept and that lose nothing: a declaration that is not at the
//! beginning of the file, an undeclared prefix. Each correction is reported.

use crate::report::finding::Finding;
use crate::text::dialect::Dialect;
use crate::text::scan::MOST_NAMESPACES;
use crate::text::source::Source;
use crate::text::syntax;
use crate::urdf::vocabulary::shown;
use std::ops::Range;

/// The namespace of prefixes that the file does not declare.
const NOWHERE: &str = "urn:mozzi:undeclared";

/// A declaration after white space is replaced by spaces, so that no place moves.
pub(crate) fn declaration(source: Source) -> (Source, Option<Finding>) {
    let is_blank = |c: char| c.is_whitespace() || c == '\u{feff}';
    let start = source.text.len() - source.text.trim_start_matches(is_blank).len();
    let rest = &source.text[start..];
    if start == 0 || !rest.starts_with('<') {
        return (source, None);
    }
    let is_declared = rest.starts_with("<?xml") && rest[5..].starts_with(|c: char| c.is_ascii_whitespace());
    let end = match rest.find("?>").filter(|_| is_declared) {
        Some(at) => start + at + 2,
        // white space alone is well-formed; a byte order mark in it is not
        None if source.text[..start].contains('\u{feff}') => start,
        None => return (source, None),
    };
    let blank = source.text[..end].bytes().map(|b| if b == b'\n' || b == b'\r' { char::from(b) } else { ' ' });
    let text = blank.collect::<String>() + &source.text[end..];
    let finding = is_declared.then(|| {
        let message = "the XML declaration is not at the beginning of the file".to_string();
        let help = "it is read as if it were; remove the blank lines before it";
        Finding::warning("late_declaration", source.place(start..start + 5), message).help(help)
    });
    (source.replaced(text), finding)
}

/// Declares undeclared prefixes on the root element, each with a finding.
pub(crate) fn prefixes(mut source: Source, dialect: Dialect) -> (Source, Vec<Finding>) {
    let mut found: Vec<(String, Range<usize>)> = Vec::new();
    while may_have_prefix(&source.text) && found.len() + source.text.matches("xmlns:").count() < MOST_NAMESPACES {
        let Some((prefix, span)) = syntax::undeclared(&source) else { break };
        let is_name = !prefix.is_empty() && prefix.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.'));
        let Some(end) = root_name_end(&source.text).filter(|_| is_name) else { break };
        found.push((prefix.clone(), source.in_file(span)));
        source = source.with_insertion(end, &format!(" xmlns:{prefix}=\"{NOWHERE}\""));
    }
    let finding = |(prefix, span): (String, Range<usize>)| {
        let (prefix, root) = (shown(&prefix), dialect.root());
        let message = format!("the prefix `{prefix}:` is not declared");
        let help = format!("it is read as if it were: declare it on the root, <{root} xmlns:{prefix}=\"…\">");
        Finding::warning("undeclared_prefix", source.place(source.in_text(span)), message).help(help)
    };
    let findings = found.into_iter().map(finding).collect();
    (source, findings)
}

/// Whether a name before a colon may be a prefix: a quick check that spares most files a second parse.
fn may_have_prefix(text: &str) -> bool {
    text.match_indices(':').any(|(at, _)| {
        let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
        let before = text[..at].trim_end_matches(is_name);
        let is_start = before.ends_with(|c: char| c.is_whitespace() || matches!(c, '<' | '/'));
        is_start && &text[before.len()..at] != "xmlns" && text[at + 1..].starts_with(is_name)
    })
}

/// The end of the root element's name.
fn root_name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        let start = at + text[at..].find('<')?;
        let rest = &text[start..];
        let end = match rest {
            _ if rest.starts_with("<!--") => "-->",
            _ if rest.starts_with("<?") => "?>",
            _ => {
                let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>');
                return Some(start + rest.find(ends)?);
            }
        };
        at = start + rest.find(end)? + end.len();
    }
}

#[cfg(test)]
mod tests {
    use crate::{Policy, parse, parse_with};

    fn said(text: &str) -> Vec<String> {
        let robot = parse("a.urdf", text).unwrap_or_else(|error| panic!("{text}\n{error}"));
        parse_with("a.urdf", text, Policy::Strict).expect_err("a warning");
        robot.warnings.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn what_stands_before_the_declaration_is_blank() {
        let robot = "<?xml version='1.0'?>\n<robot name='r'><link name='ä' odd='1'/></robot>";
        let late = "the XML declaration is not at the beginning of the file";
        for (before, line, column) in [("\n", 2, 1), ("\n\n  ", 3, 3), (" \u{feff}", 1, 3), ("\r\n", 2, 1)] {
            let found = said(&format!("{before}{robot}"));
            let odd = format!(
                "a.urdf:{}:32: warning: link `ä`: has an attribute `odd`, which URDF does not define",
                line + 1
            );
            assert_eq!(found, [odd, format!("a.urdf:{line}:{column}: warning: {late}")]);
        }
        assert_eq!(
            parse("a.urdf", "\u{feff}<robot name='r'><link name='a'/></robot>")
                .map_err(drop)
                .expect("one mark")
                .warnings
                .len(),
            0
        );
        assert!(parse("a.urdf", "\u{feff}\u{feff}\n<robot name='r'><link name='a'/></robot>").is_ok());
        assert!(parse("a.urdf", "x<?xml version='1.0'?><robot name='r'><link name='a'/></robot>").is_err());
    }

    #[test]
    fn places_after_a_declared_prefix_are_those_of_the_file() {
        let text = "<!-- <robot> -->\n<robot name='r'><link name='a' odd='1'><visual><p:x q:y='1'/><p:z/></visual></link>\n<link odd='2' name='a'/></robot>";
        let error = parse("a.urdf", text).expect_err("a name used twice");
        let found: Vec<String> = error.diagnostics().iter().map(ToString::to_string).collect();
        let place = |what: &str| {
            found.iter().find(|line| line.contains(what)).expect(what).split(':').nth(2).map(str::to_string)
        };
        let column = |what: &str| text.lines().nth(1).and_then(|line| line.find(what)).map(|at| (at + 1).to_string());
        assert_eq!(place("attribute `odd`"), column("odd"));
        assert_eq!((place("prefix `p:`"), place("prefix `q:`")), (column("p:x"), column("q:y")));
        assert_eq!(place("used twice").as_deref(), Some("21"));
        let twice = "<r:robot xmlns:r='r' name='r'><a:b/><c:d/><link name='a' x='1'/></r:robot>";
        assert!(parse("a.urdf", twice).is_err() || !said(twice).is_empty());
    }
}
