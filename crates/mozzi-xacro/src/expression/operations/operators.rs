//! Arithmetic: `+ - * / // % **`, bits, signs; joining and repeating.

use crate::bounds::MOST_BITS;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::index;
use crate::expression::operations::percent;
use crate::expression::syntax::{Binary, Unary};
use crate::expression::values::float;
use crate::expression::values::integer;
use crate::expression::values::kinds;
use crate::expression::values::value::Dictionary;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};
use std::cell::RefCell;
use std::rc::Rc;

pub(crate) fn unary(operator: Unary, value: &Value) -> Result<Value> {
    match (operator, value) {
        (Unary::Not, value) => Ok(Value::Bool(!value.truth())),
        (Unary::Minus, Value::Float(number)) => Ok(Value::Float(-number)),
        (Unary::Plus, Value::Float(number)) => Ok(Value::Float(*number)),
        (operator, value) => match (operator, value.as_int()) {
            (Unary::Minus, Some(number)) => Ok(Value::Int(-number)),
            (Unary::Plus, Some(number)) => Ok(Value::Int(number)),
            (Unary::Invert, Some(number)) => Ok(Value::Int(-number - 1)),
            _ => Err(Fault::new(format!("a {} has no sign or bits, expected a number", value.kind()))),
        },
    }
}

pub(crate) fn binary(cx: &Evaluator, operator: Binary, left: &Value, right: &Value) -> Result<Value> {
    let budget = cx.host.budget();
    if let (Some(a), Some(b)) = (left.as_int(), right.as_int()) {
        let limbs = (a.bits().max(b.bits()) / 64).min(MOST_BITS / 64);
        budget.spend(limbs * limbs / 64)?;
        if let (Value::Bool(a), Value::Bool(b)) = (left, right) {
            match operator {
                Binary::BitAnd => return Ok(Value::Bool(a & b)),
                Binary::BitOr => return Ok(Value::Bool(a | b)),
                Binary::BitXor => return Ok(Value::Bool(a ^ b)),
                _ => {}
            }
        }
        return whole(operator, &a, &b);
    }
    if left.is_number() && right.is_number() {
        return real(operator, kinds::as_float(left)?, kinds::as_float(right)?);
    }
    let count = |value: &Value| {
        let fits = |n: &BigInt| n.to_i64().ok_or_else(|| Fault::new(format!("{n} is not a number of repetitions")));
        value.as_int().map(|n| fits(&n))
    };
    match (operator, left, right) {
        (Binary::Add, Value::Str(a), Value::Str(b)) => {
            budget.text(a.len() + b.len())?;
            Ok(Value::text([&**a, &**b].concat()))
        }
        (Binary::Add, Value::List(a, _), Value::List(b, _)) => {
            budget.items(a.borrow().len() + b.borrow().len())?;
            Ok(Value::list(a.borrow().iter().chain(b.borrow().iter()).cloned().collect()))
        }
        (Binary::Add, Value::Tuple(a), Value::Tuple(b)) => {
            budget.items(a.len() + b.len())?;
            Ok(Value::Tuple(a.iter().chain(b.iter()).cloned().collect()))
        }
        (Binary::Modulo, Value::Str(template), value) => percent::format(cx, template, value),
        (Binary::Multiply, Value::Str(_) | Value::List(..) | Value::Tuple(_), other) if count(other).is_some() => {
            repeated(cx, left, count(other).unwrap_or(Ok(0))?)
        }
        (Binary::Multiply, other, Value::Str(_) | Value::List(..) | Value::Tuple(_)) if count(other).is_some() => {
            repeated(cx, right, count(other).unwrap_or(Ok(0))?)
        }
        (Binary::BitOr, Value::Dict(a, _), Value::Dict(b, _)) => {
            budget.items(a.borrow().len() + b.borrow().len())?;
            let mut entries = a.borrow().clone();
            b.borrow().entries().iter().try_for_each(|(key, value)| entries.insert(key.clone(), value.clone()))?;
            Ok(Value::dict(entries))
        }
        (_, Value::Set(a), Value::Set(b)) => sets(operator, &a.borrow(), &b.borrow()),
        _ => Err(kinds::unsupported(operator.symbol(), left, right)),
    }
}

fn whole(operator: Binary, a: &BigInt, b: &BigInt) -> Result<Value> {
    let by_zero = || Fault::new(format!("`{}` by zero", operator.symbol()));
    let shift = |bits: &BigInt| {
        if bits.is_negative() {
            return Err(Fault::new(format!("a shift by {bits} bits, expected at least 0")));
        }
        Ok(bits.to_u64().unwrap_or(u64::MAX))
    };
    let result = match operator {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide | Binary::FloorDivide | Binary::Modulo if b.is_zero() => return Err(by_zero()),
        Binary::Divide => return Ok(Value::Float(integer::divide(a, b)?)),
        Binary::FloorDivide => a.div_floor(b),
        Binary::Modulo => a.mod_floor(b),
        Binary::Power if b.is_negative() => return real(operator, integer::to_float(a)?, integer::to_float(b)?),
        Binary::Power => integer::power(a, b)?,
        Binary::ShiftLeft => match shift(b)? {
            _ if a.is_zero() => BigInt::from(0),
            bits if bits <= MOST_BITS => a << bits,
            bits => return Err(Fault::new(format!("a shift by {bits} bits, expected at most {MOST_BITS}"))),
        },
        Binary::ShiftRight => a >> shift(b)?.min(MOST_BITS + 1),
        Binary::BitAnd => a & b,
        Binary::BitOr => a | b,
        Binary::BitXor => a ^ b,
    };
    Ok(Value::Int(integer::bounded(result)?))
}

fn real(operator: Binary, a: f64, b: f64) -> Result<Value> {
    let by_zero = || Fault::new(format!("`{}` by zero", operator.symbol()));
    let result = match operator {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide | Binary::FloorDivide | Binary::Modulo if b == 0.0 => return Err(by_zero()),
        Binary::Divide => a / b,
        Binary::FloorDivide => floor_and_rest(a, b).0,
        Binary::Modulo => floor_and_rest(a, b).1,
        Binary::Power => power(a, b)?,
        _ => return Err(kinds::unsupported(operator.symbol(), &Value::Float(a), &Value::Float(b))),
    };
    Ok(Value::Float(result))
}

/// Quotient rounded down, and the remainder, whose sign is the divisor's.
pub(crate) fn floor_and_rest(a: f64, b: f64) -> (f64, f64) {
    let mut rest = a % b;
    let mut quotient = (a - rest) / b;
    if rest != 0.0 {
        if (b < 0.0) != (rest < 0.0) {
            rest += b;
            quotient -= 1.0;
        }
    } else {
        rest = 0.0f64.copysign(b);
    }
    if quotient == 0.0 {
        return (0.0f64.copysign(a / b), rest);
    }
    let down = quotient.floor();
    (if quotient - down > 0.5 { down + 1.0 } else { down }, rest)
}

fn power(a: f64, b: f64) -> Result<f64> {
    if a == 0.0 && b < 0.0 && b.is_finite() {
        return Err(Fault::new("0 to a negative power"));
    }
    if a < 0.0 && a.is_finite() && b.is_finite() && b.fract() != 0.0 {
        return Err(Fault::new("a negative number to a fractional power is complex, which is not supported"));
    }
    let result = a.powf(b);
    if result.is_infinite() && a.is_finite() && b.is_finite() {
        return Err(Fault::new(format!("{} ** {} is too large for a float", float::repr(a), float::repr(b))));
    }
    Ok(result)
}

fn repeated(cx: &Evaluator, value: &Value, count: i64) -> Result<Value> {
    let count = usize::try_from(count).unwrap_or(0);
    let budget = cx.host.budget();
    match value {
        Value::Str(text) => {
            budget.text(text.len().saturating_mul(count))?;
            Ok(Value::text(text.repeat(count)))
        }
        Value::List(items, _) => {
            budget.items(items.borrow().len().saturating_mul(count))?;
            Ok(Value::list(index::repeat(&items.borrow(), count)))
        }
        Value::Tuple(items) => {
            budget.items(items.len().saturating_mul(count))?;
            Ok(Value::Tuple(index::repeat(items, count).into()))
        }
        other => Err(Fault::new(format!("{} cannot be repeated", kinds::a_kind(other)))),
    }
}

fn sets(operator: Binary, a: &Dictionary, b: &Dictionary) -> Result<Value> {
    let has = |set: &Dictionary, key: &Value| set.get(key).map(|found| found.is_some());
    let mut kept = Vec::new();
    for key in a.keys() {
        let keeps = match operator {
            Binary::BitAnd => has(b, key)?,
            Binary::BitOr => true,
            Binary::BitXor | Binary::Subtract => !has(b, key)?,
            _ => return Err(Fault::new(format!("`{}` does not take two sets", operator.symbol()))),
        };
        if keeps {
            kept.push(key.clone());
        }
    }
    for key in b.keys() {
        if operator == Binary::BitOr || operator == Binary::BitXor && !has(a, key)? {
            kept.push(key.clone());
        }
    }
    Ok(Value::Set(Rc::new(RefCell::new(Dictionary::of_keys(kept)?))))
}
