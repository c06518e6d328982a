//! Items and slices.

use crate::expression::operations::context::Evaluator;
use crate::expression::values::kinds;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::repr;
use crate::expression::values::value::{Progression, Value};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_traits::ToPrimitive;

/// The position of an index among this many items.
pub(crate) fn place(index: &Value, count: usize, kind: &str) -> Result<usize> {
    let number = kinds::whole(index, &format!("an index of a {kind}"))?;
    let from_end = if number < 0 { number.saturating_add(count as i64) } else { number };
    usize::try_from(from_end)
        .ok()
        .filter(|k| *k < count)
        .ok_or_else(|| Fault::new(format!("the index {number} is outside of a {kind} of {count} items")))
}

pub(crate) fn item(of: &Value, at: &Value) -> Result<Value> {
    match of {
        Value::List(items, is_dotted) => {
            let items = items.borrow();
            let item = &items[place(at, items.len(), "list")?];
            Ok(if *is_dotted { item.dotted() } else { item.clone() })
        }
        Value::Tuple(items) => Ok(items[place(at, items.len(), "tuple")?].clone()),
        Value::Range(range) => Ok(range.item(place(at, range.len(), "range")?)),
        Value::Str(text) => {
            let count = if text.is_ascii() { text.len() } else { text.chars().count() };
            let k = place(at, count, "str")?;
            let c = if text.is_ascii() { text[k..].chars().next() } else { text.chars().nth(k) };
            Ok(Value::text(c.map(String::from).unwrap_or_default()))
        }
        Value::Dict(entries, is_dotted) => match entries.borrow().get(at)? {
            Some(value) => Ok(if *is_dotted { value.dotted() } else { value.clone() }),
            None => Err(Fault::new(format!("the dict has no key {}", repr::short(at)))),
        },
        other => Err(Fault::new(format!("{} has no items", a_kind(other)))),
    }
}

/// The indices of a slice of this many items, clipped as in Python.
fn bounds(values: [Option<i64>; 3], count: usize) -> Result<Progression> {
    let (count, step) = (count as i64, values[2].unwrap_or(1));
    if step == 0 {
        return Err(Fault::new("a slice with step 0"));
    }
    let (low, high) = if step > 0 { (0, count) } else { (-1, count - 1) };
    let clip = |value: i64| if value < 0 { value.saturating_add(count).max(low) } else { value.min(high) };
    let (from, to) = if step > 0 { (low, high) } else { (high, low) };
    Ok(Progression { start: values[0].map_or(from, clip), stop: values[1].map_or(to, clip), step })
}

pub(crate) fn slice(cx: &Evaluator, of: &Value, values: [Option<i64>; 3]) -> Result<Value> {
    let budget = cx.host.budget();
    let pick = |items: &[Value]| -> Result<Vec<Value>> {
        let range = bounds(values, items.len())?;
        budget.items(range.len())?;
        Ok(indices(&range).map(|k| items[k].clone()).collect())
    };
    match of {
        Value::List(items, false) => Ok(Value::list(pick(&items.borrow())?)),
        Value::List(items, true) => Ok(Value::list(pick(&items.borrow())?).dotted()),
        Value::Tuple(items) => Ok(Value::Tuple(pick(items)?.into())),
        Value::Str(text) => {
            budget.spend(1 + text.len() as u64 / 16)?;
            let letters: Vec<char> = text.chars().collect();
            let range = bounds(values, letters.len())?;
            Ok(Value::text(indices(&range).map(|k| letters[k]).collect::<String>()))
        }
        Value::Range(range) => {
            let part = bounds(values, range.len())?;
            let to = |k: i64| BigInt::from(range.start) + BigInt::from(range.step) * k;
            match (to(part.start).to_i64(), to(part.stop).to_i64(), range.step.checked_mul(part.step)) {
                (Some(start), Some(stop), Some(step)) => Ok(Value::Range(Progression { start, stop, step })),
                _ => Err(Fault::new("the range is too large")),
            }
        }
        other => Err(Fault::new(format!("{} has no slices", a_kind(other)))),
    }
}

/// The indices, which are within the items.
fn indices(range: &Progression) -> impl Iterator<Item = usize> {
    let (start, step, count) = (range.start, range.step, range.len());
    // a step larger than the items is taken at most once
    (0..count).map(move |k| start.saturating_add(step.saturating_mul(k as i64)).max(0) as usize)
}

pub(crate) fn repeat(items: &[Value], count: usize) -> Vec<Value> {
    let count = if items.is_empty() { 0 } else { count }; // else an empty tuple times 10¹⁸ never ends
    (0..count).flat_map(|_| items.iter().cloned()).collect()
}
