//! Functions of many values: `sum`, `min`, `sorted`, `zip`, `map`, …; `abs`, `round`, `divmod`, `len`.

use crate::expression::library::math;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::compare;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::operators::{binary, floor_and_rest};
use crate::expression::syntax::Binary;
use crate::expression::values::float;
use crate::expression::values::kinds;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive};
use std::cmp::Ordering;
use std::collections::VecDeque;

pub(crate) const NAMES: [&str; 15] = [
    "abs",
    "all",
    "any",
    "divmod",
    "enumerate",
    "filter",
    "len",
    "map",
    "max",
    "min",
    "reversed",
    "round",
    "sorted",
    "sum",
    "zip",
];

pub(crate) fn call(cx: &Evaluator, name: &str, mut arguments: Arguments) -> Result<Value> {
    match name {
        "min" => extreme(cx, name, arguments, Ordering::Less),
        "max" => extreme(cx, name, arguments, Ordering::Greater),
        "sorted" => {
            let (key, reverse) = (arguments.take("key"), arguments.take("reverse"));
            let [items] = arguments.exactly(name)?;
            let items = cx.items_in_any_order(&items)?;
            sort(cx, items, key.as_ref(), reverse.is_some_and(|reverse| reverse.truth())).map(Value::list)
        }
        "zip" => {
            let strict = arguments.take("strict").is_some_and(|strict| strict.truth());
            zip(cx, &arguments.only_positional(name)?, strict)
        }
        "map" => map(cx, arguments.only_positional(name)?),
        "enumerate" => {
            let [items, start] = arguments.bound(name, ["iterable", "start"], 1)?;
            let items = items.map_or(Ok(Vec::new()), |items| cx.all_items(&items))?;
            let start = start.map_or(Ok(BigInt::from(0)), |start| {
                start.as_int().ok_or_else(|| Fault::new(format!("expected an int, found {}", a_kind(&start))))
            })?;
            let pair = |(k, item): (usize, Value)| Value::Tuple([Value::Int(&start + k), item].into());
            Ok(Value::stream(items.into_iter().enumerate().map(pair).collect(), None))
        }
        "sum" => {
            let [items, start] = arguments.bound(name, ["", "start"], 1)?;
            let mut total = start.unwrap_or_else(|| Value::int(0));
            if let Value::Str(_) = total {
                return Err(Fault::new("strings are joined by `''.join(…)`"));
            }
            for item in items.map_or(Ok(Vec::new()), |items| cx.all_items(&items))? {
                total = binary(cx, Binary::Add, &total, &item)?;
            }
            Ok(total)
        }
        "round" => {
            let [number, digits] = arguments.bound(name, ["number", "ndigits"], 1)?;
            round(&number.unwrap_or(Value::None), digits.filter(|digits| !matches!(digits, Value::None)))
        }
        "filter" => {
            let [function, items] = arguments.exactly(name)?;
            let (items, mut end) = cx.items_until_error(&items)?;
            let mut kept = VecDeque::new();
            for item in items {
                let verdict = match &function {
                    Value::None => Ok(item.clone()),
                    function => cx.call(function, Arguments::of(vec![item.clone()])),
                };
                match verdict {
                    Ok(verdict) if verdict.truth() => kept.push_back(item),
                    Ok(_) => {}
                    Err(fault) => {
                        end = Some(fault);
                        break;
                    }
                }
            }
            Ok(Value::stream(kept, end))
        }
        "divmod" => {
            let [a, b] = arguments.exactly(name)?;
            divide(cx, &a, &b)
        }
        _ => {
            let [value] = arguments.exactly(name)?;
            of_one(cx, name, &value)
        }
    }
}

fn of_one(cx: &Evaluator, name: &str, value: &Value) -> Result<Value> {
    match name {
        "abs" => match (value, value.as_int()) {
            (Value::Float(number), _) => Ok(Value::Float(number.abs())),
            (_, Some(number)) => Ok(Value::Int(number.abs())),
            _ => Err(Fault::new(format!("expected a number, found {}", a_kind(value)))),
        },
        "len" => match value {
            Value::Str(text) => Ok(Value::int(text.chars().count())),
            Value::List(items, _) => Ok(Value::int(items.borrow().len())),
            Value::Tuple(items) => Ok(Value::int(items.len())),
            Value::Dict(entries, _) | Value::Set(entries) | Value::View(_, entries) => {
                Ok(Value::int(entries.borrow().len()))
            }
            Value::Range(range) => Ok(Value::int(range.len())),
            other => Err(Fault::new(format!("{} has no length", a_kind(other)))),
        },
        "any" | "all" => {
            let (items, end) = match value {
                Value::Set(_) => (cx.items_in_any_order(value)?, None),
                other => cx.items_until_error(other)?,
            };
            let stops = name == "any";
            match (items.iter().any(|item| item.truth() == stops), end) {
                (true, _) => Ok(Value::Bool(stops)),
                (false, Some(fault)) => Err(fault),
                (false, None) => Ok(Value::Bool(!stops)),
            }
        }
        _ => match value {
            Value::Set(_) | Value::Iterator(_) => Err(Fault::new(format!("{} cannot be reversed", a_kind(value)))),
            other => {
                let mut items = cx.all_items(other)?;
                items.reverse();
                Ok(Value::stream(items.into(), None))
            }
        },
    }
}

/// The least or greatest; the first one among equals.
fn extreme(cx: &Evaluator, name: &str, mut arguments: Arguments, wanted: Ordering) -> Result<Value> {
    let (key, default) = (arguments.take("key"), arguments.take("default"));
    let mut values = arguments.only_positional(name)?;
    if values.len() == 1 {
        values = cx.items_in_any_order(&values[0])?;
    } else if default.is_some() {
        return Err(Fault::new("`default` needs one argument without a name"));
    }
    let key_of = |value: &Value| match &key {
        None | Some(Value::None) => Ok(value.clone()),
        Some(key) => cx.call(key, Arguments::of(vec![value.clone()])),
    };
    let mut best: Option<(Value, Value)> = None;
    for value in values {
        let key = key_of(&value)?;
        let is_better = match &best {
            None => true,
            Some((best, _)) => {
                compare::ordered(cx, if wanted == Ordering::Less { "<" } else { ">" }, &key, best)? == Some(wanted)
            }
        };
        if is_better {
            best = Some((key, value));
        }
    }
    best.map(|(_, value)| value).or(default).ok_or_else(|| Fault::new("no values, expected at least one"))
}

/// Sorted by key; the sort is stable.
pub(crate) fn sort(cx: &Evaluator, items: Vec<Value>, key: Option<&Value>, reverse: bool) -> Result<Vec<Value>> {
    let mut keyed = Vec::with_capacity(items.len());
    for item in items {
        let key = match key {
            None | Some(Value::None) => item.clone(),
            Some(key) => cx.call(key, Arguments::of(vec![item.clone()]))?,
        };
        if matches!(key, Value::Float(number) if number.is_nan()) {
            return Err(Fault::new("nan has no place in an order"));
        }
        keyed.push((key, item));
    }
    // from the other end, equal values keep their order
    if reverse {
        keyed.reverse();
    }
    let mut sorted = by_less(cx, keyed)?;
    if reverse {
        sorted.reverse();
    }
    Ok(sorted.into_iter().map(|(_, item)| item).collect())
}

/// Pairs of a key and an item by `<` of the keys alone, which for sets or nan need not be an order. Fewer than 64 are
/// in the order of Python's list: a first run that rises or falls, and binary insertions. Halves of more are merged.
fn by_less(cx: &Evaluator, mut pairs: Vec<(Value, Value)>) -> Result<Vec<(Value, Value)>> {
    let is_less = |a: &(Value, Value), b: &(Value, Value)| -> Result<bool> {
        Ok(compare::ordered(cx, "<", &a.0, &b.0)? == Some(Ordering::Less))
    };
    let count = pairs.len();
    if count >= 64 {
        let mut right = by_less(cx, pairs.split_off(count / 2))?.into_iter().peekable();
        let mut left = by_less(cx, pairs)?.into_iter().peekable();
        let mut merged = Vec::with_capacity(count);
        while let (Some(a), Some(b)) = (left.peek(), right.peek()) {
            merged.extend(if is_less(b, a)? { right.next() } else { left.next() });
        }
        merged.extend(left.chain(right));
        return Ok(merged);
    }
    let falls = count > 1 && is_less(&pairs[1], &pairs[0])?;
    let mut run = count.min(2);
    while run < count && is_less(&pairs[run], &pairs[run - 1])? == falls {
        run += 1;
    }
    if falls {
        pairs[..run].reverse();
    }
    for k in run..count {
        let (mut low, mut high) = (0, k);
        while low < high {
            let middle = (low + high) / 2;
            if is_less(&pairs[k], &pairs[middle])? { high = middle } else { low = middle + 1 }
        }
        pairs[low..=k].rotate_right(1);
    }
    Ok(pairs)
}

fn zip(cx: &Evaluator, rows: &[Value], strict: bool) -> Result<Value> {
    let columns = rows.iter().map(|row| cx.all_items(row)).collect::<Result<Vec<_>>>()?;
    let count = columns.iter().map(Vec::len).min().unwrap_or(0);
    if strict && columns.iter().any(|column| column.len() != count) {
        return Err(Fault::new("the arguments have different lengths"));
    }
    cx.host.budget().items(count * rows.len())?;
    let tuple = |k: usize| Value::Tuple(columns.iter().map(|column| column[k].clone()).collect());
    Ok(Value::stream((0..count).map(tuple).collect(), None))
}

fn map(cx: &Evaluator, mut arguments: Vec<Value>) -> Result<Value> {
    if arguments.len() < 2 {
        return Err(Fault::new("expected a function and something to go through"));
    }
    let rows = arguments.split_off(1);
    let mut end = None;
    let mut columns = Vec::new();
    for row in &rows {
        let (items, late) = cx.items_until_error(row)?;
        end = end.or(late);
        columns.push(items);
    }
    let count = columns.iter().map(Vec::len).min().unwrap_or(0);
    let mut mapped = VecDeque::new();
    for k in 0..count {
        let values = columns.iter().map(|column| column[k].clone()).collect();
        match cx.call(&arguments[0], Arguments::of(values)) {
            Ok(value) => mapped.push_back(value),
            Err(fault) => {
                end = Some(fault);
                break;
            }
        }
    }
    Ok(Value::stream(mapped, end))
}

/// Ties to the even neighbour; without digits, an int.
fn round(number: &Value, digits: Option<Value>) -> Result<Value> {
    let digits = digits.map(|digits| kinds::whole(&digits, "`ndigits`")).transpose()?;
    match (number, number.as_int(), digits) {
        (Value::Float(number), _, None) => math::to_int(number.round_ties_even()),
        (Value::Float(number), _, Some(digits)) => float::round(*number, digits).map(Value::Float),
        (_, Some(number), None | Some(0..)) => Ok(Value::Int(number)),
        (_, Some(number), Some(digits)) => {
            let Some(places) = digits.checked_neg().and_then(|places| places.to_u32()).filter(|places| *places < 5000)
            else {
                return Ok(Value::int(0));
            };
            let unit = BigInt::from(10).pow(places);
            let (down, rest) = number.div_mod_floor(&unit);
            let up = match (rest * 2u8).cmp(&unit) {
                Ordering::Greater => true,
                Ordering::Equal => down.is_odd(),
                Ordering::Less => false,
            };
            Ok(Value::Int((down + u8::from(up)) * unit))
        }
        _ => Err(Fault::new(format!("expected a number, found {}", a_kind(number)))),
    }
}

fn divide(cx: &Evaluator, a: &Value, b: &Value) -> Result<Value> {
    if let (Value::Float(_), _) | (_, Value::Float(_)) = (a, b) {
        let (a, b) = (crate::expression::values::kinds::as_float(a)?, crate::expression::values::kinds::as_float(b)?);
        if b == 0.0 {
            return Err(Fault::new("division by zero"));
        }
        let (quotient, rest) = floor_and_rest(a, b);
        return Ok(Value::Tuple([Value::Float(quotient), Value::Float(rest)].into()));
    }
    let quotient = binary(cx, Binary::FloorDivide, a, b)?;
    Ok(Value::Tuple([quotient, binary(cx, Binary::Modulo, a, b)?].into()))
}
