//! Converts words to numbers or truth values.

use crate::expression::{Value, parse_float, parse_int};
use crate::fault::{Fault, Result};

/// Converts the literal of a property to a value: a number, a truth value, or the text in single quotes.
pub(crate) fn literal(value: Value) -> Value {
    let Value::Str(text) = &value else { return value };
    if text.len() >= 2 && text.starts_with('\'') && text.ends_with('\'') {
        return Value::text(&text[1..text.len() - 1]);
    }
    if text.contains('_') {
        return value;
    }
    if let Some(number) = parse_int(text, 10) {
        return Value::Int(number);
    }
    if let Some(number) = parse_float(text) {
        return Value::Float(number);
    }
    match &**text {
        "true" | "True" => Value::Bool(true),
        "false" | "False" => Value::Bool(false),
        _ => value,
    }
}

/// The truth value of a condition; a text must be `true`, `false` or a whole number.
pub(crate) fn truth(value: &Value) -> Result<bool> {
    let Value::Str(text) = value else { return Ok(value.truth()) };
    match &**text {
        "true" | "True" => Ok(true),
        "false" | "False" => Ok(false),
        word => match parse_int(word, 10) {
            Some(number) => Ok(Value::Int(number).truth()),
            None => Err(Fault::new(format!("the condition is `{word}`, expected true, false, or a whole number"))),
        },
    }
}
