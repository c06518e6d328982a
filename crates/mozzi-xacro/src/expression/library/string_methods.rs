//! Methods of strings: case, search, padding, tests.

use crate::expression::library::template;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::values::kinds;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use crate::space::is_space;
use std::rc::Rc;

pub(crate) const NAMES: [&str; 34] = [
    "capitalize",
    "casefold",
    "center",
    "count",
    "endswith",
    "expandtabs",
    "find",
    "format",
    "index",
    "isalnum",
    "isalpha",
    "isascii",
    "isdecimal",
    "isdigit",
    "isidentifier",
    "islower",
    "isnumeric",
    "isspace",
    "istitle",
    "isupper",
    "ljust",
    "lower",
    "removeprefix",
    "removesuffix",
    "replace",
    "rfind",
    "rindex",
    "rjust",
    "startswith",
    "swapcase",
    "title",
    "upper",
    "zfill",
    "isprintable",
];

pub(crate) fn call(cx: &Evaluator, text: &Rc<str>, name: &str, arguments: Arguments) -> Result<Value> {
    cx.host.budget().text(text.len())?;
    match name {
        "format" => template::format(cx, text, &arguments),
        "count" | "find" | "rfind" | "index" | "rindex" => search(text, name, arguments),
        "startswith" | "endswith" => ends(cx, text, name, arguments),
        "center" | "ljust" | "rjust" => pad(cx, text, name, arguments),
        "replace" => {
            let [old, new, count] = arguments.bound(name, [""; 3], 2)?;
            let (old, new) = (a_text(old.as_ref())?, a_text(new.as_ref())?);
            let count = count.map_or(Ok(-1), |count| kinds::whole(&count, "`replace`"))?;
            let most = usize::try_from(count).unwrap_or(usize::MAX);
            let found = if old.is_empty() { text.len() + 1 } else { text.matches(&*old).count() }.min(most);
            cx.host.budget().text(text.len().saturating_add(found.saturating_mul(new.len())))?;
            Ok(Value::text(if count < 0 { text.replace(&*old, &new) } else { text.replacen(&*old, &new, most) }))
        }
        "removeprefix" | "removesuffix" => {
            let [part] = arguments.exactly(name)?;
            let part = a_text(Some(&part))?;
            let rest = if name == "removeprefix" { text.strip_prefix(&*part) } else { text.strip_suffix(&*part) };
            Ok(Value::text(rest.unwrap_or(text)))
        }
        "expandtabs" => {
            let [size] = arguments.bound(name, ["tabsize"], 0)?;
            let size = size.map_or(Ok(8), |size| kinds::whole(&size, "`expandtabs`"))?;
            let size = usize::try_from(size).unwrap_or(0);
            cx.host.budget().text(text.len().saturating_add(text.matches('\t').count().saturating_mul(size)))?;
            let (mut expanded, mut column) = (String::new(), 0);
            for c in text.chars() {
                match c {
                    '\t' => {
                        let spaces = if size > 0 { size - column % size } else { 0 };
                        expanded.extend(std::iter::repeat_n(' ', spaces));
                        column += spaces;
                    }
                    c => {
                        expanded.push(c);
                        column = if matches!(c, '\n' | '\r') { 0 } else { column + 1 };
                    }
                }
            }
            Ok(Value::text(expanded))
        }
        "zfill" => {
            let [width] = arguments.exactly(name)?;
            let missing = missing(cx, text, &width)?;
            let (sign, digits) = text.split_at(usize::from(text.starts_with(['+', '-'])));
            Ok(Value::text(format!("{sign}{}{digits}", "0".repeat(missing))))
        }
        _ => {
            arguments.bound(name, [], 0)?;
            plain(text, name)
        }
    }
}

fn a_text(value: Option<&Value>) -> Result<Rc<str>> {
    match value {
        Some(Value::Str(text)) => Ok(text.clone()),
        Some(other) => Err(Fault::new(format!("expected a str, found {}", a_kind(other)))),
        None => Ok("".into()),
    }
}

/// Methods without arguments.
fn plain(text: &str, name: &str) -> Result<Value> {
    let all = |test: fn(char) -> bool| Ok(Value::Bool(!text.is_empty() && text.chars().all(test)));
    let has_case = |c: char| c.is_lowercase() || c.is_uppercase();
    let changed = match name {
        "lower" => text.to_lowercase(),
        "casefold" => text.to_lowercase().replace('ß', "ss"),
        "upper" => text.to_uppercase(),
        "capitalize" => {
            let mut letters = text.chars();
            letters
                .next()
                .map_or(String::new(), |c| c.to_uppercase().collect::<String>() + &letters.as_str().to_lowercase())
        }
        "swapcase" => text
            .chars()
            .map(|c| if c.is_uppercase() { c.to_lowercase().to_string() } else { c.to_uppercase().to_string() })
            .collect(),
        "title" => {
            let mut title = String::new();
            let mut after_letter = false;
            for c in text.chars() {
                if after_letter {
                    title.extend(c.to_lowercase())
                } else {
                    title.extend(c.to_uppercase())
                }
                after_letter = has_case(c);
            }
            title
        }
        "isalnum" => return all(char::is_alphanumeric),
        "isalpha" => return all(char::is_alphabetic),
        "isascii" => return Ok(Value::Bool(text.is_ascii())),
        "isdecimal" | "isdigit" => return all(|c| c.is_ascii_digit()),
        "isnumeric" => return all(char::is_numeric),
        "isspace" => return all(is_space),
        "isprintable" => return Ok(Value::Bool(text.chars().all(|c| c == ' ' || !c.is_control() && !is_space(c)))),
        "isidentifier" => {
            let starts = text.starts_with(crate::expression::syntax::names::begins_name);
            return Ok(Value::Bool(starts && text.chars().all(crate::expression::syntax::names::continues_name)));
        }
        "islower" => {
            return Ok(Value::Bool(text.chars().any(char::is_lowercase) && !text.chars().any(char::is_uppercase)));
        }
        "isupper" => {
            return Ok(Value::Bool(text.chars().any(char::is_uppercase) && !text.chars().any(char::is_lowercase)));
        }
        _ => {
            let (mut is_title, mut any, mut after_letter) = (true, false, false);
            for c in text.chars() {
                is_title &= if c.is_uppercase() { !after_letter } else { !c.is_lowercase() || after_letter };
                after_letter = has_case(c);
                any |= after_letter;
            }
            return Ok(Value::Bool(is_title && any));
        }
    };
    Ok(Value::text(changed))
}

/// The padding in characters up to a width, within the bound on text.
fn missing(cx: &Evaluator, text: &str, width: &Value) -> Result<usize> {
    let width = usize::try_from(kinds::whole(width, "a width")?).unwrap_or(0);
    cx.host.budget().text(width.max(text.len()))?;
    Ok(width.saturating_sub(text.chars().count()))
}

fn pad(cx: &Evaluator, text: &str, name: &str, arguments: Arguments) -> Result<Value> {
    let [width, fill] = arguments.bound(name, [""; 2], 1)?;
    let fill = fill.map_or(Ok(" ".into()), |fill| a_text(Some(&fill)))?;
    if fill.chars().count() != 1 {
        return Err(Fault::new("expected one character to fill with"));
    }
    let width = width.unwrap_or(Value::None);
    let missing = missing(cx, text, &width)?;
    cx.host.budget().text(text.len() + missing * fill.len())?;
    let width = kinds::whole(&width, "a width")?;
    let left = match name {
        "ljust" => 0,
        "rjust" => missing,
        // Python's rounding: if the width is odd, the surplus character goes to the left
        _ => missing / 2 + (missing & width.max(0) as usize & 1),
    };
    Ok(Value::text(format!("{}{text}{}", fill.repeat(left), fill.repeat(missing - left))))
}

/// The part between two indices in characters, and its beginning; None if it is out of range.
fn part(text: &str, start: Option<Value>, stop: Option<Value>) -> Result<Option<(&str, usize)>> {
    let count = text.chars().count() as i64;
    let clip = |value: Option<Value>, default: i64| match value {
        None | Some(Value::None) => Ok::<i64, Box<Fault>>(default),
        Some(value) => {
            let at = kinds::whole(&value, "a place")?;
            Ok(if at < 0 { at.saturating_add(count).max(0) } else { at })
        }
    };
    let (start, stop) = (clip(start, 0)?, clip(stop, count)?.min(count));
    if start > stop {
        return Ok(None);
    }
    let byte = |k: i64| text.char_indices().nth(k as usize).map_or(text.len(), |(at, _)| at);
    Ok(Some((&text[byte(start)..byte(stop)], start as usize)))
}

fn search(text: &str, name: &str, arguments: Arguments) -> Result<Value> {
    let [wanted, start, stop] = arguments.bound(name, [""; 3], 1)?;
    let wanted = a_text(wanted.as_ref())?;
    let found = part(text, start, stop)?;
    if name == "count" {
        let count =
            |part: &str| if wanted.is_empty() { part.chars().count() + 1 } else { part.matches(&*wanted).count() };
        return Ok(Value::int(found.map_or(0, |(part, _)| count(part))));
    }
    let place = found.and_then(|(part, from)| {
        let at = if name.starts_with('r') { part.rfind(&*wanted) } else { part.find(&*wanted) };
        at.map(|at| from + part[..at].chars().count())
    });
    match place {
        Some(at) => Ok(Value::int(at)),
        None if name.ends_with("index") => Err(Fault::new(format!("`{wanted}` is not in `{text}`"))),
        None => Ok(Value::int(-1)),
    }
}

fn ends(cx: &Evaluator, text: &str, name: &str, arguments: Arguments) -> Result<Value> {
    let [wanted, start, stop] = arguments.bound(name, [""; 3], 1)?;
    let words = match wanted {
        Some(Value::Tuple(words)) => words.iter().map(|word| a_text(Some(word))).collect::<Result<Vec<_>>>()?,
        other => vec![a_text(other.as_ref())?],
    };
    cx.spend(words.len() as u64)?;
    let Some((part, _)) = part(text, start, stop)? else { return Ok(Value::Bool(false)) };
    let is_at_end =
        |word: &Rc<str>| if name == "startswith" { part.starts_with(&**word) } else { part.ends_with(&**word) };
    Ok(Value::Bool(words.iter().any(is_at_end)))
}
