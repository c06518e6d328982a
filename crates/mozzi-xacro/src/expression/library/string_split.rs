//! Methods of strings that split or join.

use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::values::kinds;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use crate::space::is_space;

pub(crate) const NAMES: [&str; 9] =
    ["join", "lstrip", "partition", "rpartition", "rsplit", "rstrip", "split", "splitlines", "strip"];

pub(crate) fn call(cx: &Evaluator, text: &str, name: &str, arguments: Arguments) -> Result<Value> {
    cx.host.budget().text(text.len())?;
    match name {
        "join" => {
            let [items] = arguments.exactly(name)?;
            let mut joined = String::new();
            for (i, item) in cx.all_items(&items)?.iter().enumerate() {
                let Value::Str(item) = item else {
                    return Err(Fault::new(format!("`join` takes strings, found {}", a_kind(item))));
                };
                joined.push_str(if i > 0 { text } else { "" });
                joined.push_str(item);
                if joined.len() > crate::bounds::MOST_TEXT {
                    break;
                }
            }
            cx.host.budget().text(joined.len())?;
            Ok(Value::text(joined))
        }
        "strip" | "lstrip" | "rstrip" => {
            let [letters] = arguments.bound(name, [""], 0)?;
            let letters = optional_text(letters)?;
            let is_stripped = |c: char| letters.as_ref().map_or_else(|| is_space(c), |letters| letters.contains(c));
            Ok(Value::text(match name {
                "lstrip" => text.trim_start_matches(is_stripped),
                "rstrip" => text.trim_end_matches(is_stripped),
                _ => text.trim_matches(is_stripped),
            }))
        }
        "partition" | "rpartition" => {
            let [separator] = arguments.exactly(name)?;
            let separator = separator_of(optional_text(Some(separator))?)?.unwrap_or_default();
            let found = if name == "partition" { text.split_once(&*separator) } else { text.rsplit_once(&*separator) };
            let parts = match found {
                Some((before, after)) => [before, &separator, after],
                None if name == "partition" => [text, "", ""],
                None => ["", "", text],
            };
            Ok(Value::Tuple(parts.map(Value::text).into()))
        }
        "splitlines" => {
            let [keeps] = arguments.bound(name, ["keepends"], 0)?;
            let keeps = keeps.is_some_and(|keeps| keeps.truth());
            Ok(Value::list(lines(text, keeps)))
        }
        _ => {
            let [separator, most] = arguments.bound(name, ["sep", "maxsplit"], 0)?;
            let most = most.map_or(Ok(-1), |most| kinds::whole(&most, "`maxsplit`"))?;
            let most = usize::try_from(most).unwrap_or(usize::MAX);
            let parts = split(text, separator_of(optional_text(separator)?)?.as_deref(), most, name == "rsplit");
            cx.host.budget().items(parts.len())?;
            Ok(Value::list(parts.into_iter().map(Value::text).collect()))
        }
    }
}

fn optional_text(value: Option<Value>) -> Result<Option<String>> {
    match value {
        None | Some(Value::None) => Ok(None),
        Some(Value::Str(text)) => Ok(Some(text.to_string())),
        Some(other) => Err(Fault::new(format!("expected a str, found {}", a_kind(&other)))),
    }
}

fn separator_of(separator: Option<String>) -> Result<Option<String>> {
    match separator {
        Some(separator) if separator.is_empty() => Err(Fault::new("the separator is empty")),
        separator => Ok(separator),
    }
}

/// Splits by a separator, or by white space; at most this many splits, from the right if `from_right`.
fn split<'t>(text: &'t str, separator: Option<&str>, most: usize, from_right: bool) -> Vec<&'t str> {
    let count = most.saturating_add(1);
    let mut parts: Vec<&str> = match (separator, from_right) {
        (Some(separator), false) => return text.splitn(count, separator).collect(),
        (Some(separator), true) => text.rsplitn(count, separator).collect(),
        (None, _) => {
            let (mut rest, mut words) = (text, Vec::new());
            loop {
                rest = if from_right { rest.trim_end_matches(is_space) } else { rest.trim_start_matches(is_space) };
                let end = if from_right { rest.rfind(is_space) } else { rest.find(is_space) };
                match end {
                    _ if rest.is_empty() => break,
                    Some(at) if words.len() < most => {
                        let (before, after) = rest.split_at(at);
                        let after_space = after.trim_start_matches(is_space);
                        words.push(if from_right { after_space } else { before });
                        rest = if from_right { before } else { after };
                    }
                    _ => {
                        // the remainder keeps its inner white space
                        words.push(rest);
                        break;
                    }
                }
            }
            words
        }
    };
    if from_right {
        parts.reverse();
    }
    parts
}

fn lines(text: &str, keeps: bool) -> Vec<Value> {
    let (mut lines, mut rest) = (Vec::new(), text);
    let ends =
        |c: char| matches!(c, '\n' | '\r' | '\x0b' | '\x0c' | '\x1c'..='\x1e' | '\u{85}' | '\u{2028}' | '\u{2029}');
    while !rest.is_empty() {
        let at = rest.find(ends).unwrap_or(rest.len());
        let end = &rest[at..];
        let length = if end.starts_with("\r\n") { 2 } else { end.chars().next().map_or(0, char::len_utf8) };
        lines.push(Value::text(&rest[..if keeps { at + length } else { at }]));
        rest = &rest[at + length..];
    }
    lines
}
