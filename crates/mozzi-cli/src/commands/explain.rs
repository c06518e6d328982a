//! `mozzi explain`: the meaning of a diagnostic's code, with a bad and a good example.

use crate::failure::{Failure, Result};
use crate::text::{page_width, wrapped};
use clap::Args;
use mozzi_urdf::{explain, mjcf, nearest_code, remedy, sdf, why};
use std::collections::BTreeSet;

/// The examples of all codes, written by the test of mozzi-urdf that writes docs/diagnostics: `=== CODE SEVERITY`, and
/// the text to print; gzipped.
const EXAMPLES: &[u8] = include_bytes!("explain_examples.txt.gz");

#[derive(Args, Debug)]
pub struct ExplainArguments {
    /// A diagnostic's code: mozzi::urdf::zero_axis, mozzi::mjcf::zero_axis, mozzi::sdf::zero_axis, or zero_axis; or
    /// one of mozzi identify, such as lag; without one, all codes
    code: Option<String>,
}

pub fn run(arguments: &ExplainArguments) -> Result<String> {
    let Some(asked) = &arguments.code else {
        let codes: BTreeSet<&str> = codes().collect();
        let lines: String = codes.into_iter().map(|code| format!("  {code}\n")).collect();
        let of_logs = format!("Codes of `mozzi identify`: {}.", mozzi_identify::codes().collect::<Vec<_>>().join(", "));
        return Ok(format!("{lines}\n{}\n`mozzi explain zero_axis` explains one of them.\n", lines_of(&of_logs)));
    };
    let short = asked.rsplit("::").next().unwrap_or(asked);
    match explain(asked) {
        Some(text) => {
            let asked_for = ["mjcf", "sdf"].into_iter().find(|name| asked.starts_with(&format!("mozzi::{name}::")));
            let language = asked_for.unwrap_or_else(|| match short {
                _ if mozzi_urdf::codes().any(|code| code == short) => "urdf",
                _ if mjcf::codes().any(|code| code == short) => "mjcf",
                _ => "sdf",
            });
            let full = format!("mozzi::{language}::{short}");
            let mut page = format!("{full}\n\n{}", lines_of(text));
            if let Some(why) = why(&full) {
                page += &format!("\n{}", lines_of(&format!("Why it matters: {why}")));
            }
            if let Some((severity, example)) = example(&full) {
                page += &format!("\nSeverity: {severity}\n\n{example}");
            }
            if let Some(remedy) = remedy(asked) {
                page += &format!("\n{}", lines_of(&format!("Remedy: {remedy}.")));
            }
            if let Some(meaning) = mozzi_identify::meaning(asked) {
                page += &format!("\n{}", lines_of(&format!("In `mozzi identify`: {meaning}")));
            }
            Ok(page)
        }
        None => of_a_log(asked),
    }
}

/// The meaning of a code of `mozzi identify`.
fn of_a_log(asked: &str) -> Result<String> {
    if let Some(meaning) = mozzi_identify::meaning(asked) {
        let page = format!("{meaning} The message of `mozzi identify` names the place, the evidence and the remedy.");
        return Ok(format!("{asked} (`mozzi identify`)\n\n{}", lines_of(&page)));
    }
    let hint = match nearest_code(asked) {
        Some(code) => format!("did you mean `{code}`?"),
        None => "`mozzi explain` lists them".to_string(),
    };
    Err(Failure::wrong(format!("`{asked}` is not the code of a diagnostic; {hint}")))
}

/// The severity and the examples of a code of one language; those of URDF or MJCF if the language shares the code.
fn example(full: &str) -> Option<(String, String)> {
    let examples = mozzi_report::unpacked(EXAMPLES);
    let short = full.rsplit("::").next().unwrap_or(full);
    let of = |code: &str| {
        let one = examples.split("=== ").find_map(|part| part.strip_prefix(code)?.strip_prefix(' ')?.split_once('\n'));
        one.map(|(severity, text)| (severity.to_string(), text.to_string()))
    };
    of(full).or_else(|| ["urdf", "mjcf"].iter().find_map(|language| of(&format!("mozzi::{language}::{short}"))))
}

/// All codes, of any language.
fn codes() -> impl Iterator<Item = &'static str> {
    mozzi_urdf::codes().chain(mjcf::codes()).chain(sdf::codes())
}

/// The lines of a text, wrapped to the page.
fn lines_of(text: &str) -> String {
    text.lines().flat_map(|line| wrapped(line, page_width(), 0)).map(|line| line + "\n").collect()
}
