//! `docs/diagnostics.md` and `docs/diagnostics/CODE.md`: each code's meaning, consequence and remedy, with a bad and a
//! good example; and the examples that `mozzi explain` prints.
//!
//! `cargo xtask docs`, or `MOZZI_BLESS=1 cargo test -p mozzi-urdf reports`, rewrites them.

use super::{Broken, excerpt, folder, mends, models, report, robots, sdf_models};
use flate2::Compression;
use flate2::read::{GzDecoder, GzEncoder};
use mozzi_urdf::{Severity, codes, explain, mjcf, remedy, sdf, why};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::io::Read;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
# Diagnostics

The errors and warnings of `mozzi check`, and of every other command that reads a robot. Each code has a page with its meaning, its
consequence, a bad and a good example, and the remedy; `mozzi explain CODE` prints the same. An *error* refuses the file; all errors
in content are reported together, syntax errors stop at the first. After a *warning* the file is loaded; `--strict` turns warnings
into errors. What is only *counted* (looks, contact, settings) has no effect on the results. `--lenient` repairs inertias and reports
each repair.

`cargo xtask docs` writes these pages.
";

/// Lines of a report are cut here: some contain names of 300 letters.
const WIDTH: usize = 130;
const LINES: usize = 24;

/// A language: its codes' prefix, its name, and its broken files.
struct Language {
    prefix: &'static str,
    name: &'static str,
    codes: Vec<&'static str>,
    broken: Vec<Broken>,
}

fn languages() -> [Language; 3] {
    [
        Language { prefix: "urdf", name: "URDF", codes: codes().collect(), broken: robots() },
        Language { prefix: "mjcf", name: "MJCF", codes: mjcf::codes().collect(), broken: models() },
        Language { prefix: "sdf", name: "SDFormat", codes: sdf::codes().collect(), broken: sdf_models() },
    ]
}

impl Language {
    /// The plain example of a code, or its first variant.
    fn example(&self, code: &str) -> Option<&Broken> {
        let mut of = self.broken.iter().filter(|broken| broken.code() == code);
        let first = of.next()?;
        Some(self.broken.iter().find(|broken| broken.name == code).unwrap_or(first))
    }

    /// The severity of a code's findings: an error, a warning, either, or neither: counted only.
    fn severity(&self, code: &str) -> &'static str {
        let full = format!("mozzi::{}::{code}", self.prefix);
        let (mut error, mut warning) = (false, false);
        for broken in self.broken.iter().filter(|broken| broken.code() == code) {
            let diagnostics = match broken.load() {
                Ok(robot) => robot.warnings,
                Err(refused) => refused.diagnostics().to_vec(),
            };
            for found in diagnostics.iter().filter(|found| found.code() == full) {
                error |= found.severity() == Severity::Error;
                warning |= found.severity() == Severity::Warning;
            }
        }
        match (error, warning) {
            (true, true) => "error or warning",
            (true, false) => "error",
            (false, true) => "warning",
            (false, false) => "counted",
        }
    }
}

/// The text of a code in one language, as pages and `mozzi explain` have it.
struct Entry {
    full: String,
    severity: &'static str,
    /// Excerpts of the bad and of the good file.
    files: [String; 2],
    report: String,
}

fn entry(language: &Language, code: &str) -> Entry {
    let full = format!("mozzi::{}::{code}", language.prefix);
    let broken = language.example(code).unwrap_or_else(|| panic!("{full} has no example"));
    let (text, _) = report(broken);
    let diagnostics = match broken.load() {
        Ok(robot) => [robot.warnings, robot.unused].concat(),
        Err(refused) => refused.diagnostics().to_vec(),
    };
    let named = diagnostics.iter().find(|found| found.code() == full).map_or(1, |found| found.line());
    let report = text.trim_end().lines().take(LINES).map(shortened).collect();
    let bad = broken.text();
    let good = mends::mended(&format!("{}::{code}", language.prefix), &bad);
    check_mended(language, broken, &full, &good);
    Entry { full, severity: language.severity(code), files: excerpt::of(&bad, &good, named), report }
}

/// A good example is accepted without any diagnostic.
fn check_mended(language: &Language, broken: &Broken, full: &str, good: &str) {
    let path = broken.path.as_ref().map(|path| {
        let folder = std::env::temp_dir().join(format!("mozzi_mended_{}", std::process::id())).join(language.prefix);
        std::fs::create_dir_all(folder.join("parts")).expect("a writable folder");
        for part in std::fs::read_dir(path.with_file_name("parts")).expect("a folder").map(|part| part.expect("a file"))
        {
            std::fs::copy(part.path(), folder.join("parts").join(part.file_name())).expect("a writable folder");
        }
        let path = folder.join(path.file_name().expect("a file"));
        std::fs::write(&path, good).expect("a writable folder");
        path
    });
    let mended = Broken { name: broken.name.clone(), text: good.as_bytes().to_vec(), path };
    let robot = mended.load().unwrap_or_else(|error| panic!("{full}: the good example is refused: {error}"));
    // a section of MJCF may be read in part, and is then also counted as ignored
    let rest = [robot.warnings, robot.unused].concat();
    let rest = rest.iter().map(mozzi_urdf::Diagnostic::code).filter(|code| *code != "mozzi::mjcf::ignored_element");
    assert_eq!(rest.collect::<Vec<_>>(), Vec::<&str>::new(), "{full}: the good example is not without diagnostics");
}

impl Entry {
    fn meaning(&self) -> &'static str {
        explain(&self.full).unwrap_or_else(|| panic!("{} has no meaning", self.full))
    }

    /// The part of a page.
    fn markdown(&self, page: &mut String) {
        let Entry { full, severity, report, files: [bad, good] } = self;
        let why = why(full).unwrap_or_else(|| panic!("{full} has no consequence in src/report/why.rs"));
        let remedy = remedy(full).unwrap_or_else(|| panic!("{full} has no remedy"));
        let (meaning, why, remedy) = (escaped(self.meaning()), escaped(why), escaped(remedy));
        let _ = writeln!(page, "\n`{full}`, *{severity}*. {meaning}\n\n**Why it matters**: {why}\n\n**Bad**");
        if has_text(bad) {
            let _ = write!(page, "\n```xml\n{bad}```\n");
        }
        let _ = write!(page, "\n```text\n{report}```\n\n**Good**\n\n```xml\n{good}```\n\n**Remedy**: {remedy}.\n");
    }

    /// The part of the examples of `mozzi explain`.
    fn plain(&self, all: &mut String) {
        let Entry { full, severity, report, files: [bad, good] } = self;
        let indented = |text: &str| {
            text.lines().fold(String::new(), |all, line| format!("{all}    {line}").trim_end().to_string() + "\n")
        };
        let bad = if has_text(bad) { indented(bad) + "\n" } else { String::new() };
        let _ = write!(all, "=== {full} {severity}\nBad:\n\n{bad}{report}\nGood:\n\n{}", indented(good));
    }
}

/// False for excerpts of files without content.
fn has_text(excerpt: &str) -> bool {
    excerpt.contains(|letter: char| !letter.is_whitespace() && letter != '…')
}

/// Markdown takes `<mimic>` outside of code for HTML.
fn escaped(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts.map(|(k, part)| if k % 2 == 0 { part.replace('<', "\\<") } else { format!("`{part}`") }).collect()
}

/// Sentences continue in a line of their own, lines of a file are cut.
fn shortened(line: &str) -> String {
    let is_sentence =
        ["error[", "warning[", "help: "].iter().any(|start| line.trim_start_matches([' ', '=']).starts_with(start));
    if !is_sentence {
        return match line.char_indices().nth(WIDTH) {
            Some((at, _)) => format!("{}…\n", &line[..at]),
            None => format!("{line}\n"),
        };
    }
    let (mut text, mut width) = (String::new(), 0);
    for word in line.split_inclusive(' ') {
        if width + word.trim_end().chars().count() > WIDTH {
            text.truncate(text.trim_end().len());
            text.push_str("\n    ");
            width = 4;
        }
        text.push_str(word);
        width += word.chars().count();
    }
    text + "\n"
}

/// All files that are written, by their path in the repository.
fn pages() -> BTreeMap<String, String> {
    let languages = languages();
    let all: BTreeSet<&str> = languages.iter().flat_map(|language| language.codes.iter().copied()).collect();
    let (mut pages, mut examples) = (BTreeMap::new(), String::new());
    let mut index = format!("{HEAD}\n| code | severity | in | meaning |\n|---|---|---|---|\n");
    for code in all {
        let (own, shared): (Vec<&Language>, Vec<&Language>) = languages
            .iter()
            .filter(|language| language.example(code).is_some())
            .partition(|language| language.codes.contains(&code));
        let mut page = format!("# `{code}`\n");
        let entries: Vec<Entry> = own.iter().map(|language| entry(language, code)).collect();
        for (language, entry) in own.iter().zip(&entries) {
            if own.len() > 1 {
                let _ = writeln!(page, "\n## {}", language.name);
            }
            entry.markdown(&mut page);
            entry.plain(&mut examples);
        }
        let others: Vec<String> =
            shared.iter().map(|language| format!("{} (`mozzi::{}::{code}`)", language.name, language.prefix)).collect();
        if !others.is_empty() {
            let _ = writeln!(page, "\nThe code has the same meaning in {}.", others.join(" and in "));
        }
        let names: Vec<&str> = languages
            .iter()
            .filter(|language| language.example(code).is_some())
            .map(|language| language.name)
            .collect();
        let severities: BTreeSet<&str> = entries.iter().flat_map(|entry| entry.severity.split(" or ")).collect();
        let severity = severities.into_iter().collect::<Vec<_>>().join(" or ");
        let meaning = entries[0].meaning();
        let sentence = meaning.split_once(". ").map_or(meaning.trim_end_matches('.'), |(first, _)| first);
        let _ = writeln!(
            index,
            "| [`{code}`](diagnostics/{code}.md) | {severity} | {} | {}. |",
            names.join(", "),
            escaped(sentence)
        );
        pages.insert(format!("docs/diagnostics/{code}.md"), page);
    }
    pages.insert("docs/diagnostics.md".to_string(), index);
    pages.insert("crates/mozzi-cli/src/commands/explain_examples.txt.gz".to_string(), examples);
    pages
}

/// Writes a text, gzipped if its name says so.
fn write(path: &Path, text: &str) {
    let mut bytes = text.as_bytes().to_vec();
    if path.extension().is_some_and(|ending| ending == "gz") {
        bytes.clear();
        GzEncoder::new(text.as_bytes(), Compression::best()).read_to_end(&mut bytes).expect("in memory");
    }
    std::fs::write(path, bytes).expect("a writable folder");
}

fn read(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    match path.extension().is_some_and(|ending| ending == "gz") {
        true => GzDecoder::new(std::fs::File::open(path)?).read_to_string(&mut text).map(|_| text),
        false => std::fs::read_to_string(path),
    }
}

#[test]
fn the_pages_of_all_codes_are_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder_of_pages = root.join("docs/diagnostics");
    let pages = pages();
    let bless = std::env::var_os("MOZZI_BLESS").is_some();
    if bless {
        std::fs::create_dir_all(&folder_of_pages).expect("a writable folder");
        pages.iter().for_each(|(file, text)| write(&root.join(file), text));
    }
    for (file, page) in &pages {
        let written = read(&root.join(file)).unwrap_or_default().replace("\r\n", "\n");
        assert!(written == *page, "{file} is not current: run `cargo xtask docs` (from {})", folder().display());
    }
    let is_stale = |path: &PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy();
        !pages.contains_key(&format!("docs/diagnostics/{name}"))
    };
    let there = std::fs::read_dir(&folder_of_pages).expect("a folder").map(|entry| entry.expect("an entry").path());
    let stale: Vec<PathBuf> = there.filter(is_stale).collect();
    if bless {
        stale.iter().for_each(|path| std::fs::remove_file(path).expect("a writable folder"));
    } else {
        assert!(stale.is_empty(), "pages of codes that do not exist: {stale:?}: run `cargo xtask docs`");
    }
}

#[test]
fn every_edit_belongs_to_a_code() {
    let of = |prefix: &'static str, codes: Vec<&str>| {
        codes.into_iter().map(move |code| format!("{prefix}::{code}")).collect()
    };
    let known: [Vec<String>; 3] =
        [of("urdf", codes().collect()), of("mjcf", mjcf::codes().collect()), of("sdf", sdf::codes().collect())];
    let known: BTreeSet<String> = known.concat().into_iter().collect();
    let edited: Vec<String> = mends::codes().map(str::to_string).collect();
    assert_eq!(edited.len(), known.len());
    assert!(edited.iter().all(|code| known.contains(code)));
}
