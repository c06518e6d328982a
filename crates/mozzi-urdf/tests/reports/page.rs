//! `docs/diagnostics.md`: every code, its meaning, its remedy, and an example.
//!
//! `cargo xtask docs`, or `MOZZI_BLESS=1 cargo test -p mozzi-urdf reports`, rewrites it.

use super::{Broken, folder, models, report, robots, sdf_models};
use mozzi_urdf::{Severity, codes, explain, mjcf, remedy, sdf};
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "\
# Diagnostics

The errors and warnings of `mozzi check`, and of every other command that reads a robot, with an example of each. `mozzi explain
CODE` prints the same texts. An *error* refuses the file; all errors in content are reported together, syntax errors stop at the
first. After a *warning* the file is loaded; `--strict` turns warnings into errors (but not what is only counted: looks, contact, settings).
`--lenient` repairs inertias and reports each repair.

`cargo xtask docs` writes this page.
";

/// Lines of an example are cut here: some contain names of 300 letters.
const WIDTH: usize = 130;
const LINES: usize = 24;

/// The plain example of a code, or its first variant.
fn example<'b>(all: &'b [Broken], code: &str) -> Option<&'b Broken> {
    let mut of = all.iter().filter(|broken| broken.code() == code);
    let first = of.next()?;
    Some(all.iter().find(|broken| broken.name == code).unwrap_or(first))
}

/// The severity of its findings: an error, a warning, or either.
fn severity(all: &[Broken], language: &str, code: &str) -> &'static str {
    let full = format!("mozzi::{language}::{code}");
    let (mut error, mut warning) = (false, false);
    for broken in all.iter().filter(|broken| broken.code() == code) {
        let diagnostics = match broken.load() {
            Ok(robot) => [robot.warnings, robot.unused].concat(),
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
        _ => "warning",
    }
}

/// The entry of one code.
fn entry(page: &mut String, all: &[Broken], language: &str, code: &str) {
    let full = format!("mozzi::{language}::{code}");
    let (meaning, mend) = (explain(&full).unwrap_or_default(), remedy(&full).unwrap_or_default());
    let _ = writeln!(page, "\n### `{full}`\n\n*{}*. {meaning}\n\n**Remedy**: {mend}.", severity(all, language, code));
    let Some(broken) = example(all, code) else { return };
    let (text, _) = report(broken);
    let lines: String = text.trim_end().lines().take(LINES).map(shortened).collect();
    let _ = write!(page, "\n```text\n{lines}```\n");
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

fn page() -> String {
    let (robots, models) = (robots(), models());
    let mut page = String::from(HEAD);
    let _ = writeln!(page, "\n## URDF");
    codes().for_each(|code| entry(&mut page, &robots, "urdf", code));
    let own: Vec<&str> = mjcf::codes().collect();
    let is_own = |code: &&str| own.contains(code);
    let shared: Vec<String> = codes()
        .filter(|code| !is_own(code) && example(&models, code).is_some())
        .map(|code| format!("`{code}`"))
        .collect();
    let _ = writeln!(
        page,
        "\n## MJCF\n\nThese mean what they mean in URDF, and begin with `mozzi::mjcf::`: {}.",
        shared.join(", ")
    );
    own.iter().for_each(|code| entry(&mut page, &models, "mjcf", code));
    let sdf_models = sdf_models();
    let own: Vec<&str> = sdf::codes().collect();
    let shared: Vec<String> = codes()
        .filter(|code| !own.contains(code) && example(&sdf_models, code).is_some())
        .map(|code| format!("`{code}`"))
        .collect();
    let _ = writeln!(
        page,
        "\n## SDFormat\n\nThese mean what they mean in URDF, and begin with `mozzi::sdf::`: {}.",
        shared.join(", ")
    );
    own.iter().for_each(|code| entry(&mut page, &sdf_models, "sdf", code));
    page
}

#[test]
fn the_page_of_all_codes_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/diagnostics.md");
    let page = page();
    if std::env::var_os("MOZZI_BLESS").is_some() {
        std::fs::create_dir_all(file.parent().expect("docs")).expect("a writable folder");
        std::fs::write(&file, &page).expect("a writable folder");
    }
    let written = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    assert!(
        written == page,
        "docs/diagnostics.md is not current: run `cargo xtask docs` (from {})",
        folder().display()
    );
}
