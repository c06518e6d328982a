//! Five habits that doc comments and docstrings avoid: questions, "The same …", "Of …" and "What …" at the beginning
//! of a paragraph, and machines that talk.

use crate::report::Outcome;
use crate::source_text::{code_only, without_literals, without_tests};
use crate::workspace::{Workspace, files};

/// Beginnings of a paragraph, and what to write instead.
const BEGINNINGS: [(&str, &str); 3] = [
    ("The same", "begins \"The same\": state what the item does or contains"),
    ("Of", "begins with a headless \"Of\": begin with the noun, or write \"dopri only: …\""),
    ("What", "begins \"What\": begin with the noun that it stands for"),
];
/// Verbs of people.
const SPOKEN: [&str; 8] = ["asks", "asked", "answers", "answered", "says", "said", "tells", "told"];
/// Phrases with such a verb that are about people.
const ALLOWED: [&str; 4] = ["user asks for", "user asked for", "caller asks for", "caller asked for"];

/// Fails if a doc comment of the crates, the benchmarks, the examples or xtask, or a docstring of the Python package
/// has one of the five habits; tests are left out.
pub fn check(workspace: &Workspace) -> Outcome {
    let mut sources = Vec::new();
    for folder in ["crates", "benches/src", "examples", "xtask/src"] {
        files(&workspace.path(folder), &["rs"], &mut sources);
    }
    files(&workspace.path("crates/mozzi-py/python"), &["py", "pyi"], &mut sources);
    sources.sort();
    let (mut read, mut broken) = (0, 0);
    for file in &sources {
        let name = workspace.name_of(file);
        if !is_judged(&name) {
            continue;
        }
        let Ok(source) = std::fs::read_to_string(file) else {
            return Outcome::Failed(format!("{name} cannot be read"));
        };
        read += 1;
        let paragraphs = if name.ends_with(".rs") { doc_comments(&source) } else { docstrings(&source) };
        for (line, rule) in paragraphs.iter().flat_map(Paragraph::broken_rules) {
            println!("{name}:{line}: {rule}");
            broken += 1;
        }
    }
    match broken {
        0 => Outcome::Passed(format!("{read} files")),
        _ => Outcome::Failed(format!("{broken} places in {read} files: write what is printed above")),
    }
}

/// True for all files except tests; only `src` and the Python package of a crate are read.
fn is_judged(name: &str) -> bool {
    let parts: Vec<_> = name.split('/').collect();
    let is_test = |part: &&str| ["tests", "tests.rs"].contains(part) || part.ends_with("_tests.rs");
    let is_source = parts[0] != "crates" || ["src", "python"].contains(parts.get(2).unwrap_or(&""));
    is_source && !(parts[0] == "crates" && parts.iter().any(is_test))
}

/// A paragraph or list item of documentation: its lines with their numbers; code in backticks is blanked.
#[derive(Default)]
struct Paragraph(Vec<(usize, String)>);

impl Paragraph {
    /// The line and the rule of each violation.
    fn broken_rules(&self) -> Vec<(usize, String)> {
        let Some((first, _)) = self.0.first() else { return Vec::new() };
        let text = self.0.iter().map(|(_, line)| line.trim()).collect::<Vec<_>>().join(" ");
        let text = without_code_spans(&text);
        let mut broken = Vec::new();
        if first_sentence(&text).ends_with('?') {
            broken.push((*first, "documentation as a question: write a statement, e.g. \"True if …\"".to_owned()));
        }
        let has_begin = |begin| text.strip_prefix(begin).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric));
        let begun = BEGINNINGS.iter().filter(|(begin, _)| has_begin(*begin));
        broken.extend(begun.map(|(_, rule)| (*first, (*rule).to_owned())));
        let lower = text.to_lowercase();
        let people = ALLOWED.iter().fold(lower, |text, phrase| text.replace(phrase, "user"));
        let words = people.split(|c: char| !c.is_alphanumeric() && c != '_');
        for word in words.filter(|word| SPOKEN.contains(word)) {
            let line = self.0.iter().find(|(_, line)| line.to_lowercase().contains(word));
            let rule = format!("\"{word}\": write call, query, check, require, return, report, warn or state");
            broken.push((line.map_or(*first, |(line, _)| *line), rule));
        }
        broken
    }
}

/// The text with everything between backticks replaced by `x`.
fn without_code_spans(text: &str) -> String {
    text.split('`').enumerate().map(|(index, part)| if index % 2 == 0 { part } else { "x" }).collect()
}

/// The text up to the first full stop, question mark or exclamation mark that is followed by a space or by nothing.
fn first_sentence(text: &str) -> &str {
    let mut ends = text.char_indices().filter(|(_, c)| ['.', '?', '!'].contains(c)).map(|(at, _)| at + 1);
    let is_end = |at: &usize| text[*at..].chars().next().is_none_or(char::is_whitespace);
    let is_abbreviation = |at: usize| ["e.g.", "i.e.", "cf.", "eq."].iter().any(|short| text[..at].ends_with(short));
    ends.find(|at| is_end(at) && !is_abbreviation(*at)).map_or(text, |at| &text[..at])
}

/// The paragraphs of the comments `///` and `//!` outside tests.
fn doc_comments(source: &str) -> Vec<Paragraph> {
    const OUTSIDE: char = '\u{1}'; // without_tests blanks this mark where it blanks the code
    let marked = without_tests(&code_only(source).replace('\n', &format!("{OUTSIDE}\n")));
    let is_outside = marked.lines().map(|line| line.ends_with(OUTSIDE));
    let comments = without_literals(source);
    let docs = comments.lines().zip(is_outside).map(|(line, is_outside)| {
        let line = line.trim_start();
        let doc = line.strip_prefix("///").filter(|rest| !rest.starts_with('/'));
        doc.or_else(|| line.strip_prefix("//!")).filter(|_| is_outside)
    });
    let mut is_code = false;
    paragraphs(docs.map(|line| {
        let line = line.or_else(|| {
            is_code = false;
            None
        })?;
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        (!is_fence && !is_code).then_some(line)
    }))
}

/// The paragraphs of the strings in triple quotes that begin a line, without examples.
fn docstrings(source: &str) -> Vec<Paragraph> {
    const QUOTES: &str = "\"\"\"";
    let (mut is_open, mut is_other, mut is_example, mut indent) = (false, false, false, 0);
    let mut lines = Vec::new();
    for line in source.lines() {
        let text = line.trim_start();
        let begin = text.trim_start_matches('r').strip_prefix(QUOTES).filter(|_| !is_open && !is_other);
        is_open |= begin.is_some();
        is_other ^= !is_open && text.matches(QUOTES).count() % 2 == 1; // a string that is a value
        let text = begin.unwrap_or(text);
        let (text, closes) = text.split_once(QUOTES).map_or((text, false), |(text, _)| (text, true));
        is_example = text.starts_with(">>>") || is_example && !text.is_empty() && begin.is_none();
        let is_title = !text.is_empty() && text.chars().all(|c| c == '-');
        let new_indent = line.len() - line.trim_start().len();
        // A description is indented below its name, and is a paragraph of its own.
        let is_part = is_open && !is_example && !is_title;
        lines.push((is_part.then_some(text), new_indent != indent || begin.is_some()));
        indent = new_indent;
        is_open &= !closes;
    }
    let mut found = vec![Paragraph::default()];
    for (index, (text, begins)) in lines.into_iter().enumerate() {
        add_line(&mut found, index + 1, text, begins);
    }
    found
}

fn paragraphs<'t>(lines: impl Iterator<Item = Option<&'t str>>) -> Vec<Paragraph> {
    let mut found = vec![Paragraph::default()];
    for (index, line) in lines.enumerate() {
        add_line(&mut found, index + 1, line, false);
    }
    found
}

/// Adds a line to the last paragraph, or to a new one; `None` and an empty line end a paragraph.
fn add_line(found: &mut Vec<Paragraph>, number: usize, line: Option<&str>, begins: bool) {
    let text = line.unwrap_or("").trim();
    let item = text.trim_start_matches(|c: char| c.is_ascii_digit());
    let item = if item.len() < text.len() { item.strip_prefix(". ") } else { None };
    let item = item.or_else(|| text.strip_prefix("- ").or_else(|| text.strip_prefix("* ")));
    let heading = text.starts_with('#').then(|| text.trim_start_matches('#').trim());
    if begins || text.is_empty() || item.is_some() || heading.is_some() {
        found.push(Paragraph::default());
    }
    let text = item.or(heading).unwrap_or(text);
    if let Some(last) = found.last_mut().filter(|_| !text.is_empty() && !text.starts_with("| ")) {
        last.0.push((number, text.to_owned()));
    }
}

#[cfg(test)]
mod tests {
    use super::{Paragraph, doc_comments, docstrings, first_sentence, is_judged};

    const NONE: [usize; 0] = [];

    fn lines(paragraphs: &[Paragraph]) -> Vec<(usize, String)> {
        let broken = paragraphs.iter().flat_map(Paragraph::broken_rules);
        broken.map(|(line, rule)| (line, rule.split_inclusive(' ').take(2).collect::<String>())).collect()
    }

    fn rust(source: &str) -> Vec<usize> {
        lines(&doc_comments(source)).into_iter().map(|(line, _)| line).collect()
    }

    fn python(source: &str) -> Vec<usize> {
        lines(&docstrings(source)).into_iter().map(|(line, _)| line).collect()
    }

    #[test]
    fn each_habit_is_found() {
        let source = "//! The same. By columns.\n\n/// Is it\n/// one? Yes.\nfn a() {}\n    /// Of each joint.\n    b: u8,\n\
                      /// What moves.\n///\n/// - Of links.\nc;\n/// Asks `f`,\n/// which answers.\n";
        let found = lines(&doc_comments(source));
        let numbers: Vec<_> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(numbers, [1, 3, 6, 8, 10, 12, 13]);
        assert_eq!(found[1].1, "documentation as ");
        assert_eq!(found[5].1, "\"asks\": write ");
    }

    #[test]
    fn plain_comments_break_nothing() {
        assert_eq!(
            rust("/// True if it is one number: `a?` of all. The same\n/// holds for links.\nfn a() {}\n"),
            NONE
        );
        assert_eq!(rust("// What f answers?\n//// The same again?\nf(\"/// Of links\");\n"), NONE);
        assert_eq!(rust("let text = r\"\n/// Of links\n\";\n"), NONE);
        assert_eq!(
            rust("/// Rows.\n///\n/// ```\n/// f(\"What\"); // says\n/// ```\n/// | Of | What |\nfn a() {}\n"),
            NONE
        );
        assert_eq!(rust("/// True if the user asked for it; `says` and unasked.\nfn a() {}\n"), NONE);
    }

    #[test]
    fn a_fence_that_is_left_open_ends_with_its_comment() {
        assert_eq!(rust("/// ```\n/// Of code\nfn a() {}\n/// Of links\nfn b() {}\n"), [4]);
    }

    #[test]
    fn tests_are_left_out() {
        assert_eq!(
            rust("#[cfg(test)]\nmod tests {\n    /// Of links.\n    fn f() {}\n}\n/// Of links.\nfn g() {}\n"),
            [6]
        );
        assert!(is_judged("crates/mozzi/src/a.rs") && is_judged("examples/a.rs") && is_judged("xtask/src/tests.rs"));
        assert!(is_judged("crates/mozzi-py/python/mozzi/a.pyi"));
        let tests = ["crates/mozzi/tests/a.rs", "crates/mozzi/src/a/tests.rs", "crates/mozzi/src/a_tests.rs"];
        assert!(!tests.into_iter().any(is_judged));
    }

    #[test]
    fn docstrings_are_read() {
        let source = "def f(a):\n    \"\"\"Of links.\n\n    Is it?\n\n    Parameters\n    ----------\n    a : float\n        \
                      What moves.\n\n    >>> f(1)\n    'The same says'\n    \"\"\"\n    return \"What \" + told\n";
        assert_eq!(python(source), [2, 4, 9]);
        assert_eq!(python("x = 1  # Of\nr\"\"\"The same again.\"\"\"\n"), [2]);
        assert_eq!(python("x = \"\"\"Of\n\"\"\"\nWhat(\"says\")\n"), NONE);
    }

    #[test]
    fn a_sentence_ends_before_a_space() {
        assert_eq!(first_sentence("At 0.5 e.g. here? No."), "At 0.5 e.g. here?");
        assert_eq!(first_sentence("No end"), "No end");
    }
}
