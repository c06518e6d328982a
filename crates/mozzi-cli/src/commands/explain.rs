//! `mozzi explain`: what a diagnostic's code means.

use crate::failure::{Failure, Result};
use crate::text::{page_width, width};
use clap::Args;
use mozzi_urdf::{codes, explain};
use std::collections::BTreeSet;

#[derive(Args, Debug)]
pub struct ExplainArguments {
    /// A diagnostic's code: mozzi::urdf::zero_axis, or zero_axis; without one, all codes
    code: Option<String>,
}

pub fn run(arguments: &ExplainArguments) -> Result<String> {
    let Some(asked) = &arguments.code else {
        let lines: String = codes().map(|code| format!("  {code}\n")).collect();
        return Ok(format!("{lines}\n`mozzi explain zero_axis` tells what one of them means.\n"));
    };
    let short = asked.rsplit("::").next().unwrap_or(asked);
    match explain(asked) {
        Some(text) => Ok(format!("mozzi::urdf::{short}\n\n{}", wrapped(text))),
        None => {
            let hint = match nearest(short) {
                Some(code) => format!("did you mean `{code}`?"),
                None => "`mozzi explain` lists them".to_string(),
            };
            Err(Failure::wrong(format!("`{asked}` is not the code of a diagnostic; {hint}")))
        }
    }
}

/// The code that has most pairs of letters in common, if it has half of them.
fn nearest(word: &str) -> Option<&'static str> {
    let pairs = |text: &str| {
        let letters: Vec<char> = format!("^{}$", text.to_lowercase().replace('-', "_")).chars().collect();
        letters.windows(2).map(|pair| (pair[0], pair[1])).collect::<BTreeSet<_>>()
    };
    let mine = pairs(word);
    let alike = |code: &str| {
        let its = pairs(code);
        2.0 * mine.intersection(&its).count() as f64 / (mine.len() + its.len()) as f64
    };
    codes().map(|code| (alike(code), code)).filter(|(x, _)| *x >= 0.5).max_by(|a, b| a.0.total_cmp(&b.0)).map(|x| x.1)
}

/// In lines that fit the page; lines that stand alone stay so.
fn wrapped(text: &str) -> String {
    let mut page = String::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split(' ') {
            if !line.is_empty() && width(&line) + 1 + width(word) > page_width() {
                page.push_str(&line);
                page.push('\n');
                line.clear();
            } else if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        page.push_str(&line);
        page.push('\n');
    }
    page
}
