//! `template.format(…)`.

use crate::bounds::MOST_TEXT;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::format;
use crate::expression::operations::index;
use crate::expression::values::repr;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};

/// How fields are numbered: automatically, or explicitly. Python does not allow both in one template.
#[derive(Default)]
struct Numbering {
    next: usize,
    is_automatic: bool,
    is_manual: bool,
}

pub(crate) fn format(cx: &Evaluator, template: &str, arguments: &Arguments) -> Result<Value> {
    let mut out = String::new();
    expand(cx, template, arguments, &mut Numbering::default(), 2, &mut out)?;
    cx.host.budget().text(out.len())?;
    Ok(Value::text(out))
}

fn expand(
    cx: &Evaluator,
    template: &str,
    arguments: &Arguments,
    numbering: &mut Numbering,
    depth: usize,
    out: &mut String,
) -> Result<()> {
    let mut rest = template;
    while let Some(at) = rest.find(['{', '}']) {
        out.push_str(&rest[..at]);
        let (brace, after) = rest[at..].split_at(1);
        rest = after;
        if rest.starts_with(brace) {
            out.push_str(brace);
            rest = &rest[1..];
            continue;
        }
        if brace == "}" {
            return Err(Fault::new("a single `}` in the format"));
        }
        if depth == 0 {
            return Err(Fault::new("a format in a format in a format"));
        }
        let end = closing(rest)?;
        let field = &rest[..end];
        rest = &rest[end + 1..];
        let (name, specification) = split(field);
        let (name, conversion) = match name.rsplit_once('!') {
            Some((name, conversion)) if !conversion.contains(']') => (name, Some(conversion)),
            _ => (name, None),
        };
        let value = lookup(cx, name, arguments, numbering)?;
        let value = match conversion {
            None => value,
            Some("s") => Value::text(crate::expression::values::repr::text_of(cx.host.budget(), &value)?),
            Some("r" | "a") => Value::text(repr::repr(cx.host.budget(), &value)?),
            Some(other) => return Err(Fault::new(format!("`!{other}` is not a conversion"))),
        };
        let mut inner = String::new();
        expand(cx, specification, arguments, numbering, depth - 1, &mut inner)?;
        out.push_str(&format::format(cx.host.budget(), &value, &inner)?);
        if out.len() > MOST_TEXT {
            cx.host.budget().text(out.len())?;
        }
    }
    out.push_str(rest);
    Ok(())
}

/// The end of the field, past braces inside it.
fn closing(text: &str) -> Result<usize> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => return Ok(at),
            '}' => depth -= 1,
            _ => {}
        }
    }
    Err(Fault::new("`{` of the format is never closed"))
}

/// The name and the specification, separated by a colon outside of brackets.
fn split(field: &str) -> (&str, &str) {
    let mut in_brackets = false;
    for (at, c) in field.char_indices() {
        match c {
            '[' => in_brackets = true,
            ']' => in_brackets = false,
            ':' if !in_brackets => return (&field[..at], &field[at + 1..]),
            _ => {}
        }
    }
    (field, "")
}

/// `0`, `name`, `name.attribute`, `name[item]`
fn lookup(cx: &Evaluator, field: &str, arguments: &Arguments, numbering: &mut Numbering) -> Result<Value> {
    let end = field.find(['.', '[']).unwrap_or(field.len());
    let (name, mut rest) = field.split_at(end);
    let place = if name.is_empty() {
        numbering.is_automatic = true;
        numbering.next += 1;
        Some(numbering.next - 1)
    } else if name.bytes().all(|b| b.is_ascii_digit()) {
        numbering.is_manual = true;
        Some(name.parse().unwrap_or(usize::MAX))
    } else {
        None
    };
    if numbering.is_automatic && numbering.is_manual {
        return Err(Fault::new("the format mixes `{}` with `{0}`"));
    }
    let found = match place {
        Some(place) => arguments.positional.get(place),
        None => arguments.named.iter().find(|(known, _)| **known == *name).map(|(_, value)| value),
    };
    let mut value = found.cloned().ok_or_else(|| Fault::new(format!("the format has no value for `{{{field}}}`")))?;
    while let Some(first) = rest.chars().next() {
        let inner = &rest[1..];
        if first == '.' {
            let end = inner.find(['.', '[']).unwrap_or(inner.len());
            value = cx.attribute(&value, &inner[..end].into())?;
            rest = &inner[end..];
        } else {
            let end = inner.find(']').ok_or_else(|| Fault::new("`[` of the format is never closed"))?;
            let key = &inner[..end];
            let is_number = !key.is_empty() && key.bytes().all(|b| b.is_ascii_digit());
            let key = match key.parse::<i64>() {
                Ok(number) if is_number => Value::int(number),
                _ => Value::text(key),
            };
            value = index::item(&value, &key)?;
            rest = &inner[end + 1..];
            if !rest.is_empty() && !rest.starts_with(['.', '[']) {
                return Err(Fault::new("only `.` or `[` may follow `]` in a format"));
            }
        }
    }
    Ok(value)
}
