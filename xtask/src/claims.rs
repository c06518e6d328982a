//! `cargo xtask claims`: every measured number of README and the documentation with its source.
//!
//! - A page that a command writes names the command ([`WRITTEN`]).
//! - Blocks of code are compared with what is printed, by `cargo xtask book --code` and the tests.
//! - Records of decisions keep the numbers of their day ([`HISTORY`]).
//! - Other numbers with a unit, a power of ten or a per cent sign need a source in their paragraph or list: a
//!   command in backquotes (`cargo …`, `python …`), a link to a written page, or a comment `<!-- from: KIND NAME -->`,
//!   which may follow the paragraph. Kinds: `test NAME`, a function of a test; `in FILE NAME`, a word of a source
//!   file, such as a constant; `given`, a number that is chosen and not measured, such as an exercise's.

use crate::documents::HISTORY;
use crate::report::Outcome;
use crate::workspace::{Workspace, files};

/// Pages that commands write, each with its command as the page names it.
const WRITTEN: &[(&str, &str)] = &[
    ("docs/accuracy.md", "cargo xtask accuracy"),
    ("docs/agreement.md", "cargo xtask test"),
    ("docs/arm.md", "cargo xtask jit-report"),
    ("docs/campaign.md", "cargo xtask campaign"),
    ("docs/coverage.md", "cargo xtask coverage"),
    ("docs/diagnostics.md", "cargo xtask docs"),
    ("docs/gpu.md", "cargo xtask gpu-report"),
    ("docs/mutants.md", "cargo xtask mutants"),
    ("docs/published-models.md", "cargo xtask docs"),
    ("docs/published-robots.md", "cargo xtask docs"),
    ("docs/quantities.md", "cargo xtask docs"),
    ("docs/weight.md", "cargo xtask weigh"),
    ("benches/CONTACTS.md", "cargo xtask bench --contacts"),
    ("benches/GPU.md", "cargo xtask gpu-bench"),
    ("benches/RESULTS.md", "cargo xtask bench"),
    ("benches/jax/RESULTS.md", "python benches/jax/compare.py"),
];
/// Pages whose numbers need a source each: files, and folders with all their pages.
const PAGES: [&str; 5] = ["README.md", "CONVENTIONS.md", "crates/mozzi-py/README.md", "docs", "book/src"];
/// Units of measured numbers.
const UNITS: [&str; 24] = [
    "ns",
    "µs",
    "ms",
    "s",
    "min",
    "h",
    "kB",
    "MB",
    "GB",
    "GiB",
    "MiB",
    "%",
    "×",
    "times",
    "lines",
    "characters",
    "columns",
    "digits",
    "m/s",
    "mm",
    "cm",
    "µm",
    "nm",
    "CPU",
];
/// Where test functions and constants are looked for.
const SOURCES: [&str; 4] = ["crates", "benches", "examples", "xtask"];

/// A paragraph with numbers.
struct Claim {
    place: String,
    numbers: Vec<String>,
    source: Option<String>,
}

/// Prints the list.
pub fn list(workspace: &Workspace) -> Outcome {
    run(workspace, true)
}

/// Prints what has no source alone.
pub fn check(workspace: &Workspace) -> Outcome {
    run(workspace, false)
}

fn run(workspace: &Workspace, prints_all: bool) -> Outcome {
    match try_run(workspace, prints_all) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_run(workspace: &Workspace, prints_all: bool) -> Result<Outcome, String> {
    let mut wrong = 0;
    for &(page, command) in WRITTEN {
        let text = workspace.read(page)?;
        if !text.contains(command) {
            println!("{page}: does not name the command that writes it, `{command}`");
            wrong += 1;
        }
        if prints_all {
            println!("{page}: {} numbers, `{command}`", whole_numbers(&text));
        }
    }
    let mut sources = Sources::default();
    let (mut found, mut pages) = (0, Vec::new());
    for page in PAGES {
        files(&workspace.path(page), &["md"], &mut pages);
    }
    pages.sort();
    for file in pages {
        let name = workspace.name_of(&file);
        if HISTORY.contains(&name.as_str())
            || WRITTEN.iter().any(|(page, _)| *page == name)
            || name.starts_with("docs/diagnostics/")
        {
            continue;
        }
        for claim in claims(&name, &workspace.read(&name)?) {
            found += 1;
            let problem = match &claim.source {
                None => Some("has no source".to_owned()),
                Some(source) => sources.problem(workspace, source),
            };
            let numbers = claim.numbers.join(", ");
            match problem {
                Some(problem) => {
                    println!("{}: {numbers}: {problem}", claim.place);
                    wrong += 1;
                }
                None if prints_all => println!("{}: {numbers}: {}", claim.place, claim.source.unwrap_or_default()),
                None => {}
            }
        }
    }
    let note = format!("{} written pages, {found} paragraphs with numbers", WRITTEN.len());
    Ok(if wrong == 0 { Outcome::Passed(note) } else { Outcome::Failed(format!("{wrong} without a source; {note}")) })
}

/// The paragraphs of a page that have measured numbers outside of code, each with its source.
fn claims(page: &str, text: &str) -> Vec<Claim> {
    let (mut claims, mut is_code, mut paragraph, mut start): (Vec<Claim>, _, _, _) =
        (Vec::new(), false, String::new(), 0);
    let mut is_next = false; // the last claim is in the paragraph before
    for (at, line) in text.lines().chain([""]).enumerate() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
            continue;
        }
        if is_code {
            continue;
        }
        if !line.trim().is_empty() {
            if paragraph.is_empty() {
                start = at + 1;
            }
            paragraph += &format!("{line}\n");
            continue;
        }
        let source = source(&paragraph);
        let numbers = numbers(&prose(&paragraph));
        if !numbers.is_empty() {
            claims.push(Claim { place: format!("{page}:{start}"), numbers, source });
            is_next = true;
        } else if !paragraph.is_empty() {
            let open = claims.last_mut().filter(|claim| is_next && claim.source.is_none());
            if let (Some(claim), Some(source)) = (open, source) {
                claim.source = Some(source); // a comment, or the sentence below a table
            }
            is_next = false;
        }
        paragraph.clear();
    }
    claims
}

/// A paragraph's source.
fn source(paragraph: &str) -> Option<String> {
    if let Some((_, rest)) = paragraph.split_once("<!-- from: ") {
        return Some(rest.split(" -->").next()?.to_owned());
    }
    let command = paragraph.split('`').skip(1).step_by(2).find(|code| {
        ["cargo ", "python "].iter().any(|program| code.starts_with(program)) && !code.contains("cargo install")
    });
    if let Some(command) = command {
        return Some(format!("`{}`", command.replace('\n', " ")));
    }
    let links = paragraph.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    let file = |link: &str| link.rsplit("../").next().unwrap_or(link).to_owned();
    links.map(file).find(|link| !link.is_empty() && WRITTEN.iter().any(|(page, _)| page.ends_with(link.as_str())))
}

/// A paragraph without code, formulas, links' targets and comments.
fn prose(paragraph: &str) -> String {
    let mut text = paragraph.to_owned();
    for (start, end) in [("<!--", "-->"), ("](", ")"), ("`", "`"), ("$", "$")] {
        let mut out = String::new();
        let mut rest = text.as_str();
        while let Some(from) = rest.find(start) {
            let Some(length) = rest[from + start.len()..].find(end) else { break };
            out += &rest[..from];
            rest = &rest[from + start.len() + length + end.len()..];
        }
        text = out + rest;
    }
    text
}

/// The numbers with a unit, and powers of ten.
fn numbers(prose: &str) -> Vec<String> {
    let words: Vec<&str> = prose.split([' ', '\n', '|', '(', ')']).filter(|word| !word.is_empty()).collect();
    let mut found = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let bare = word.trim_end_matches([',', '.', ';', ':']);
        let number = bare.trim_start_matches(['−', '-', '±', '≤', '≥', '<', '>', '~']);
        let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit() || c == '.' || c == ',');
        if number.contains("10⁻") || number.contains("10⁹") || number.contains("10⁶") {
            found.push(bare.to_owned());
        } else if let Some(number) = number.strip_suffix(['%', '×']).filter(|number| digits(number)) {
            found.push(number.to_owned());
        } else if digits(number) && *word == bare {
            let unit = words.get(at + 1).map_or("", |word| word.trim_end_matches([',', '.', ';', ':']));
            let is_size = unit == "×"
                && words
                    .get(at + 2)
                    .is_some_and(|word| digits(word) || word.trim_end_matches(',') == "n" || word.starts_with("10⁻"));
            if UNITS.contains(&unit) && !is_size {
                found.push(format!("{number} {unit}"));
            }
        }
    }
    found
}

/// Numbers of any kind, to say how many a page has.
fn whole_numbers(text: &str) -> usize {
    let is_number = |word: &&str| word.starts_with(|c: char| c.is_ascii_digit());
    text.split(|c: char| c.is_whitespace() || c == '|').filter(is_number).count()
}

/// The text of the source files, read once.
#[derive(Default)]
struct Sources {
    text: Option<String>,
}

impl Sources {
    /// Why a source does not exist, if it does not.
    fn problem(&mut self, workspace: &Workspace, source: &str) -> Option<String> {
        let words: Vec<&str> = source.split(' ').collect();
        match words[..] {
            ["test", name] => {
                let text = self.text.get_or_insert_with(|| all_sources(workspace));
                let is_there = text.contains(&format!("fn {name}(")) || text.contains(&format!("def {name}("));
                (!is_there).then(|| format!("there is no test `{name}`"))
            }
            ["in", file, name] => match workspace.read(file) {
                Ok(text) if text.contains(name) => None,
                Ok(_) => Some(format!("{file} does not contain `{name}`")),
                Err(why) => Some(why),
            },
            ["given"] => None,
            _ if source.starts_with('`') || source.ends_with(".md") => None,
            _ => Some(format!("`{source}` is no source")),
        }
    }
}

fn all_sources(workspace: &Workspace) -> String {
    let mut sources = Vec::new();
    for folder in SOURCES {
        files(&workspace.path(folder), &["rs", "py"], &mut sources);
    }
    sources.iter().filter_map(|file| std::fs::read_to_string(file).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::{claims, numbers, source};

    #[test]
    fn numbers_have_units_or_powers_of_ten() {
        assert_eq!(numbers("it takes 0.7 s, at most 5 % and 2·10⁻⁷ m"), ["0.7 s", "5 %", "2·10⁻⁷"]);
        assert_eq!(numbers("section 8.7 of 2026 with 6 joints"), [""; 0]);
    }

    #[test]
    fn a_paragraph_names_its_source() {
        assert_eq!(source("5 ms by `cargo xtask bench`").as_deref(), Some("`cargo xtask bench`"));
        assert_eq!(source("see [times](../benches/RESULTS.md)").as_deref(), Some("benches/RESULTS.md"));
        assert_eq!(source("5 ms <!-- from: test a_b -->").as_deref(), Some("test a_b"));
        assert_eq!(source("5 ms"), None);
    }

    #[test]
    fn a_source_may_follow_its_paragraph() {
        let found = claims("a.md", "It takes 5 ms.\n\n<!-- from: given -->\n\nIn 3 s.\n");
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].place.as_str(), found[0].source.as_deref()), ("a.md:1", Some("given")));
        assert_eq!((found[1].place.as_str(), found[1].source.as_deref()), ("a.md:5", None));
    }

    #[test]
    fn code_has_no_claims() {
        assert!(claims("a.md", "```text\n5 ms\n```\n`5 ms`\n").is_empty());
    }
}
