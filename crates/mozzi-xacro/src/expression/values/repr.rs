//! Values as text: `str(value)` and `repr(value)`.

use crate::bounds::{Budget, MOST_TEXT};
use crate::expression::values::float;
use crate::expression::values::integer;
use crate::expression::values::value::{Value, View};
use crate::fault::{Fault, Result};

/// `str(value)`.
pub(crate) fn text_of(budget: &Budget, value: &Value) -> Result<String> {
    match value {
        Value::Str(text) => {
            budget.text(text.len())?;
            Ok(text.to_string())
        }
        other => repr(budget, other),
    }
}

/// `repr(value)`.
pub(crate) fn repr(budget: &Budget, value: &Value) -> Result<String> {
    let mut out = String::new();
    write(budget, value, &mut out)?;
    budget.text(out.len())?;
    Ok(out)
}

/// A shortened `repr`, for messages.
pub(crate) fn short(value: &Value) -> String {
    let text = repr(&Budget::default(), value).unwrap_or_else(|_| value.kind().to_string());
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

fn write(budget: &Budget, value: &Value, out: &mut String) -> Result<()> {
    budget.spend(1)?;
    if out.len() > MOST_TEXT {
        budget.text(out.len())?;
    }
    match value {
        Value::None => out.push_str("None"),
        Value::Bool(value) => out.push_str(if *value { "True" } else { "False" }),
        Value::Int(number) => {
            budget.spend((number.bits() / 64).pow(2) / 16)?;
            out.push_str(&integer::text(number)?);
        }
        Value::Float(number) => out.push_str(&float::repr(*number)),
        Value::Str(text) => quoted(text, out),
        Value::List(items, _) => sequence(budget, &items.borrow(), ["[", "]"], out)?,
        Value::Tuple(items) if items.len() == 1 => sequence(budget, items, ["(", ",)"], out)?,
        Value::Tuple(items) => sequence(budget, items, ["(", ")"], out)?,
        Value::Dict(entries, _) => {
            out.push('{');
            for (i, (key, value)) in entries.borrow().entries().iter().enumerate() {
                out.push_str(if i > 0 { ", " } else { "" });
                budget.deeper(|| write(budget, key, out))?;
                out.push_str(": ");
                budget.deeper(|| write(budget, value, out))?;
            }
            out.push('}');
        }
        Value::Set(entries) => match entries.borrow().ordered_keys() {
            Some(keys) if keys.is_empty() => out.push_str("set()"),
            Some(keys) => sequence(budget, &keys, ["{", "}"], out)?,
            None => return Err(Fault::new("the order of this set is not defined, expected `sorted(…)` of it")),
        },
        Value::Range(range) if range.step == 1 => out.push_str(&format!("range({}, {})", range.start, range.stop)),
        Value::Range(range) => out.push_str(&format!("range({}, {}, {})", range.start, range.stop, range.step)),
        Value::View(view, entries) => {
            let entries = entries.borrow();
            let items: Vec<Value> = entries
                .entries()
                .iter()
                .map(|(key, value)| match view {
                    View::Keys => key.clone(),
                    View::Values => value.clone(),
                    View::Items => Value::Tuple([key.clone(), value.clone()].into()),
                })
                .collect();
            out.push_str(value.kind());
            sequence(budget, &items, ["([", "])"], out)?;
        }
        Value::Function(function) => match function.shown() {
            Some(shown) => out.push_str(&shown),
            None => return Err(no_text(value)),
        },
        Value::Iterator(_) | Value::Method(_) | Value::Lambda(_) | Value::Namespace(_) | Value::Module(_) => {
            return Err(no_text(value));
        }
    }
    Ok(())
}

fn no_text(value: &Value) -> Box<Fault> {
    Fault::new(format!("{} has no text, expected a value", crate::expression::values::kinds::a_kind(value)))
}

fn sequence(budget: &Budget, items: &[Value], brackets: [&str; 2], out: &mut String) -> Result<()> {
    out.push_str(brackets[0]);
    for (i, item) in items.iter().enumerate() {
        out.push_str(if i > 0 { ", " } else { "" });
        budget.deeper(|| write(budget, item, out))?;
    }
    out.push_str(brackets[1]);
    Ok(())
}

/// A string in the quotes that Python chooses.
fn quoted(text: &str, out: &mut String) {
    let quote = if text.contains('\'') && !text.contains('"') { '"' } else { '\'' };
    out.push(quote);
    for c in text.chars() {
        match c {
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            c if c == quote => out.extend(['\\', c]),
            c if (c as u32) < 0x20 || c as u32 == 0x7f => out.push_str(&format!("\\x{:02x}", c as u32)),
            c if (0x80..0xa1).contains(&(c as u32)) || c as u32 == 0xad => {
                out.push_str(&format!("\\x{:02x}", c as u32));
            }
            c => out.push(c),
        }
    }
    out.push(quote);
}
