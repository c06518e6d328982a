//! Comparisons.

use crate::expression::operations::context::Evaluator;
use crate::expression::syntax::Compare;
use crate::expression::values::integer;
use crate::expression::values::value::{Value, View};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_traits::FromPrimitive;
use std::cmp::Ordering;
use std::rc::Rc;

pub(crate) fn holds(cx: &Evaluator, operator: Compare, left: &Value, right: &Value) -> Result<bool> {
    match operator {
        Compare::Equal => equal(cx, left, right),
        Compare::NotEqual => Ok(!equal(cx, left, right)?),
        Compare::In => contains(cx, right, left),
        Compare::NotIn => Ok(!contains(cx, right, left)?),
        Compare::Is => is_same(left, right),
        Compare::IsNot => Ok(!is_same(left, right)?),
        Compare::Less => Ok(ordered(cx, "<", left, right)? == Some(Ordering::Less)),
        Compare::Greater => Ok(ordered(cx, ">", left, right)? == Some(Ordering::Greater)),
        Compare::LessEqual => Ok(matches!(ordered(cx, "<=", left, right)?, Some(Ordering::Less | Ordering::Equal))),
        Compare::GreaterEqual => {
            Ok(matches!(ordered(cx, ">=", left, right)?, Some(Ordering::Greater | Ordering::Equal)))
        }
    }
}

/// The order of two numbers; None if one is NaN.
fn numbers(left: &Value, right: &Value) -> Option<Ordering> {
    match (left, right) {
        (Value::Float(a), Value::Float(b)) => a.partial_cmp(b),
        (Value::Float(a), _) => mixed(*a, &right.as_int()?),
        (_, Value::Float(b)) => mixed(*b, &left.as_int()?).map(Ordering::reverse),
        _ => Some(left.as_int()?.cmp(&right.as_int()?)),
    }
}

/// Compares a float and an int exactly.
fn mixed(float: f64, int: &BigInt) -> Option<Ordering> {
    if float.is_nan() {
        return None;
    }
    if let Ok(other) = integer::to_float(int)
        && int.bits() <= 53
    {
        return float.partial_cmp(&other);
    }
    match BigInt::from_f64(float) {
        Some(whole) if !float.is_infinite() => {
            let order = whole.cmp(int);
            // the float's fractional part
            Some(if order == Ordering::Equal { float.fract().partial_cmp(&0.0)? } else { order })
        }
        _ => float.partial_cmp(&0.0), // infinite or NaN
    }
}

pub(crate) fn equal(cx: &Evaluator, left: &Value, right: &Value) -> Result<bool> {
    let budget = cx.host.budget();
    budget.spend(1)?;
    Ok(match (left, right) {
        (Value::None, Value::None) => true,
        (Value::Str(a), Value::Str(b)) => {
            budget.spend(a.len().min(b.len()) as u64 / 64)?;
            a == b
        }
        (Value::List(a, _), Value::List(b, _)) => {
            Rc::ptr_eq(a, b) || budget.deeper(|| all_equal(cx, &a.borrow(), &b.borrow()))?
        }
        (Value::Tuple(a), Value::Tuple(b)) => budget.deeper(|| all_equal(cx, a, b))?,
        (Value::Dict(a, _), Value::Dict(b, _)) => {
            let (a, b) = (a.borrow(), b.borrow());
            if a.len() != b.len() {
                return Ok(false);
            }
            for (key, value) in a.entries() {
                match b.get(key)? {
                    Some(other) if budget.deeper(|| equal(cx, value, other))? => {}
                    _ => return Ok(false),
                }
            }
            true
        }
        (Value::Set(a), Value::Set(b)) => a.borrow().len() == b.borrow().len() && subset(&a.borrow(), &b.borrow())?,
        (Value::Range(a), Value::Range(b)) => {
            a.len() == b.len() && (a.len() == 0 || a.start == b.start && (a.len() == 1 || a.step == b.step))
        }
        (Value::Function(a), Value::Function(b)) => a == b,
        (Value::Module(a), Value::Module(b)) => a == b,
        _ if left.is_number() && right.is_number() => numbers(left, right) == Some(Ordering::Equal),
        _ => false,
    })
}

fn all_equal(cx: &Evaluator, a: &[Value], b: &[Value]) -> Result<bool> {
    if a.len() != b.len() {
        return Ok(false);
    }
    for (a, b) in a.iter().zip(b) {
        if !equal(cx, a, b)? {
            return Ok(false);
        }
    }
    Ok(true)
}

fn subset(
    a: &crate::expression::values::value::Dictionary,
    b: &crate::expression::values::value::Dictionary,
) -> Result<bool> {
    for key in a.keys() {
        if b.get(key)?.is_none() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The order of two values; None if there is none, as with NaN.
pub(crate) fn ordered(cx: &Evaluator, symbol: &str, left: &Value, right: &Value) -> Result<Option<Ordering>> {
    cx.spend(1)?;
    match (left, right) {
        (Value::Str(a), Value::Str(b)) => Ok(Some(a.cmp(b))),
        (Value::List(a, _), Value::List(b, _)) => {
            cx.host.budget().deeper(|| by_items(cx, symbol, &a.borrow(), &b.borrow()))
        }
        (Value::Tuple(a), Value::Tuple(b)) => cx.host.budget().deeper(|| by_items(cx, symbol, a, b)),
        (Value::Set(a), Value::Set(b)) => {
            let (a, b) = (a.borrow(), b.borrow());
            Ok(match (subset(&a, &b)?, subset(&b, &a)?) {
                (true, true) => Some(Ordering::Equal),
                (true, false) => Some(Ordering::Less),
                (false, true) => Some(Ordering::Greater),
                (false, false) => None,
            })
        }
        _ if left.is_number() && right.is_number() => Ok(numbers(left, right)),
        _ => Err(crate::expression::values::kinds::unsupported(symbol, left, right)),
    }
}

fn by_items(cx: &Evaluator, symbol: &str, a: &[Value], b: &[Value]) -> Result<Option<Ordering>> {
    for (a, b) in a.iter().zip(b) {
        if !equal(cx, a, b)? {
            return ordered(cx, symbol, a, b);
        }
    }
    Ok(Some(a.len().cmp(&b.len())))
}

fn contains(cx: &Evaluator, container: &Value, value: &Value) -> Result<bool> {
    match container {
        Value::Str(text) => match value {
            Value::Str(part) => {
                cx.spend(text.len() as u64 / 64)?;
                Ok(text.contains(&**part))
            }
            other => Err(Fault::new(format!("`in` a string takes a str, found a {}", other.kind()))),
        },
        Value::Dict(entries, _) | Value::Set(entries) | Value::View(View::Keys, entries) => {
            Ok(entries.borrow().get(value)?.is_some())
        }
        Value::Namespace(scope) => match value {
            Value::Str(name) => Ok(cx.host.member(scope, name)?.is_some()),
            _ => Ok(false),
        },
        other => {
            for item in cx.items_in_any_order(other)? {
                if equal(cx, &item, value)? {
                    return Ok(true);
                }
            }
            Ok(false)
        }
    }
}

/// `is`, where Python defines it: for None, True, False, and objects that are shared.
fn is_same(left: &Value, right: &Value) -> Result<bool> {
    Ok(match (left, right) {
        (Value::None, Value::None) => true,
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::List(a, _), Value::List(b, _)) => Rc::ptr_eq(a, b),
        (Value::Dict(a, _), Value::Dict(b, _)) | (Value::Set(a), Value::Set(b)) => Rc::ptr_eq(a, b),
        (Value::Function(a), Value::Function(b)) => a == b,
        (Value::Int(_), Value::Int(_)) | (Value::Float(_), Value::Float(_)) | (Value::Str(_), Value::Str(_)) => {
            return Err(Fault::new("`is` between numbers or strings is not defined, expected `==`"));
        }
        _ => false,
    })
}
