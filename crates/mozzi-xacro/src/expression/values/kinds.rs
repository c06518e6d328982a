//! Values of an expected kind, and how errors name kinds.

use crate::expression::values::integer;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_traits::{Signed, ToPrimitive};

pub(crate) fn unsupported(symbol: &str, left: &Value, right: &Value) -> Box<Fault> {
    Fault::new(format!("`{symbol}` does not take {} and {}", a_kind(left), a_kind(right)))
}

/// "an int", "a float"
pub(crate) fn a_kind(value: &Value) -> String {
    let kind = value.kind();
    format!("{} {kind}", if kind == "int" || kind == "iterator" { "an" } else { "a" })
}

pub(crate) fn as_float(value: &Value) -> Result<f64> {
    match value {
        Value::Float(number) => Ok(*number),
        Value::Int(number) => integer::to_float(number),
        Value::Bool(value) => Ok(f64::from(u8::from(*value))),
        other => Err(Fault::new(format!("expected a number, found {}", a_kind(other)))),
    }
}

/// A whole number for an index, a count or a size; a number beyond 64 bits is clamped.
pub(crate) fn whole(value: &Value, what: &str) -> Result<i64> {
    match value.as_int() {
        Some(number) => Ok(number.to_i64().unwrap_or(if number.is_negative() { i64::MIN } else { i64::MAX })),
        None => Err(Fault::new(format!("{what} takes an int, found {}", a_kind(value)))),
    }
}
