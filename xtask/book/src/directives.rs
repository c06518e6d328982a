//! Lines `{{…}}` of a chapter, which the book's builder replaces.
//!
//! - `{{item FILE NAME}}`: the lines of one function or type of a source file;
//! - `{{lines FILE | FIRST | LAST}}`: the lines from the one that contains FIRST to the one that contains LAST;
//! - `{{robot NAME}}`: the live page of an embedded robot; `{{motion PAGE NAME OPTIONS…}}`: of a motion of it.
//!
//! If a kernel is renamed or its lines change, the book is not built.

use crate::item;
use crate::robots::{self, Robots};
use crate::text;
use std::path::Path;

/// What the directives of all chapters asked for.
#[derive(Default)]
pub struct Asked {
    pub robots: Robots,
    pub items: usize,
}

/// Replaces the directives of a piece of prose; `up` leads from the page to the book's root.
pub fn replace(root: &Path, prose: &str, up: &str, asked: &mut Asked) -> Result<String, String> {
    let mut lines = Vec::new();
    for line in prose.split('\n') {
        let inside = line.trim().strip_prefix("{{").and_then(|line| line.strip_suffix("}}"));
        lines.push(match inside {
            Some(directive) => {
                one(root, directive.trim(), up, asked).map_err(|error| format!("`{}`: {error}", line.trim()))?
            }
            None => line.to_owned(),
        });
    }
    Ok(lines.join("\n"))
}

fn one(root: &Path, directive: &str, up: &str, asked: &mut Asked) -> Result<String, String> {
    let (kind, rest) = directive.split_once(' ').ok_or("a directive has arguments")?;
    match kind {
        "item" => {
            let (file, name) = rest.trim().split_once(' ').ok_or("expected FILE NAME")?;
            asked.items += 1;
            Ok(listing(file, &item::item(&text::read(&root.join(file))?, name.trim())?))
        }
        "lines" => {
            let parts: Vec<&str> = rest.split(" | ").map(str::trim).collect();
            let [file, first, last] = parts[..] else { return Err("expected FILE | FIRST | LAST".into()) };
            asked.items += 1;
            Ok(listing(file, &item::between(&text::read(&root.join(file))?, first, last)?))
        }
        "robot" => live(up, rest.trim(), rest.trim(), &[], asked),
        "motion" => {
            let words: Vec<&str> = rest.split_whitespace().collect();
            let [page, model, ref options @ ..] = words[..] else { return Err("expected PAGE MODEL OPTIONS".into()) };
            live(up, page, model, options, asked)
        }
        _ => Err("is no directive".into()),
    }
}

/// Source lines under their file's name. A path from the repository's root begins with `/` in links.
fn listing(file: &str, code: &str) -> String {
    let language = if file.ends_with(".json") { "json" } else { "rust,ignore" };
    format!("From [{file}](/{file}):\n\n```{language}\n{code}\n```")
}

fn live(up: &str, page: &str, model: &str, options: &[&str], asked: &mut Asked) -> Result<String, String> {
    let command = text::escaped(&robots::add(&mut asked.robots, page, model, options)?);
    Ok(format!(
        "<figure class=\"robot\"><iframe src=\"{up}robots/{page}.html\" title=\"{model}\" loading=\"lazy\"></iframe>\
         <figcaption><a href=\"{up}robots/{page}.html\">Open it alone.</a> Made by <code>{command}</code></figcaption></figure>"
    ))
}
