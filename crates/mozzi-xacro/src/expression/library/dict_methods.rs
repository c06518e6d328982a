//! Methods of dictionaries and sets.

use crate::bounds::MOST_ITEMS;
use crate::expression::library::types;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::compare;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::operators;
use crate::expression::syntax::{Binary, Compare};
use crate::expression::values::repr;
use crate::expression::values::value::Dictionary;
use crate::expression::values::value::{Entries, Value, View};
use crate::fault::{Fault, Result};
use std::cell::RefCell;
use std::rc::Rc;

pub(crate) const NAMES: [&str; 10] =
    ["clear", "copy", "get", "items", "keys", "pop", "popitem", "setdefault", "update", "values"];
pub(crate) const SET_NAMES: [&str; 9] =
    ["add", "copy", "difference", "discard", "intersection", "issubset", "issuperset", "symmetric_difference", "union"];

/// For a dictionary from YAML, Python's own methods use the plain values: without dotted access. A copy is a plain
/// dict.
pub(crate) fn call(cx: &Evaluator, dict: &Entries, name: &str, arguments: Arguments) -> Result<Value> {
    let count = dict.borrow().len();
    cx.spend(1 + count as u64 / 64)?;
    let missing = |key: &Value| Fault::new(format!("the dict has no key {}", repr::short(key)));
    match name {
        "keys" | "values" | "items" => {
            arguments.bound(name, [], 0)?;
            let view = match name {
                "keys" => View::Keys,
                "values" => View::Values,
                _ => View::Items,
            };
            Ok(Value::View(view, dict.clone()))
        }
        "get" => {
            let [key, default] = arguments.bound(name, [""; 2], 1)?;
            let found = dict.borrow().get(&key.unwrap_or(Value::None))?.cloned();
            Ok(found.or(default).unwrap_or(Value::None))
        }
        "pop" => {
            let [key, default] = arguments.bound(name, [""; 2], 1)?;
            let key = key.unwrap_or(Value::None);
            cx.spend(count as u64 / 8)?;
            let removed = dict.borrow_mut().remove(&key)?;
            removed.map(|(_, value)| value).or(default).ok_or_else(|| missing(&key))
        }
        "popitem" => {
            arguments.bound(name, [], 0)?;
            let last = dict.borrow().keys().last().cloned();
            let last = last.ok_or_else(|| Fault::new("the dict is empty"))?;
            let removed = dict.borrow_mut().remove(&last)?;
            removed.map(|(key, value)| Value::Tuple([key, value].into())).ok_or_else(|| missing(&last))
        }
        "setdefault" => {
            let [key, default] = arguments.bound(name, [""; 2], 1)?;
            let key = key.unwrap_or(Value::None);
            if let Some(found) = dict.borrow().get(&key)? {
                return Ok(found.clone());
            }
            let default = default.unwrap_or(Value::None);
            limit(cx, count + 1)?;
            dict.borrow_mut().insert(key, default.clone())?;
            Ok(default)
        }
        "update" => {
            let mut entries = Dictionary::default();
            if arguments.positional.len() > 1 {
                return Err(Fault::new("`update` takes one argument without a name"));
            }
            if let Some(first) = arguments.positional.first() {
                types::extend(cx, &mut entries, first)?;
            }
            limit(cx, count + entries.len())?;
            let mut dict = dict.borrow_mut();
            entries.entries().iter().try_for_each(|(key, value)| dict.insert(key.clone(), value.clone()))?;
            arguments.named.into_iter().try_for_each(|(key, value)| dict.insert(Value::Str(key), value))?;
            Ok(Value::None)
        }
        "clear" => {
            arguments.bound(name, [], 0)?;
            dict.borrow_mut().clear();
            Ok(Value::None)
        }
        _ => {
            arguments.bound(name, [], 0)?;
            cx.host.budget().items(count)?;
            Ok(Value::dict(dict.borrow().clone()))
        }
    }
}

fn limit(cx: &Evaluator, count: usize) -> Result<()> {
    if count > MOST_ITEMS { cx.host.budget().items(count) } else { Ok(()) }
}

pub(crate) fn call_set(cx: &Evaluator, set: &Entries, name: &str, arguments: Arguments) -> Result<Value> {
    cx.host.budget().items(set.borrow().len())?;
    let of = |items: Vec<Value>| Ok(Value::Set(Rc::new(RefCell::new(Dictionary::of_keys(items)?))));
    match name {
        "copy" => {
            arguments.bound(name, [], 0)?;
            return of(set.borrow().keys().cloned().collect());
        }
        "add" | "discard" => {
            let [key] = arguments.exactly(name)?;
            if name == "discard" {
                set.borrow_mut().remove(&key)?;
            } else if set.borrow().get(&key)?.is_none() {
                limit(cx, set.borrow().len() + 1)?;
                set.borrow_mut().insert(key, Value::None)?;
            }
            return Ok(Value::None);
        }
        _ => {}
    }
    let [other] = arguments.exactly(name)?;
    let (this, other) = (Value::Set(set.clone()), of(cx.items_in_any_order(&other)?)?);
    match name {
        "issubset" => compare::holds(cx, Compare::LessEqual, &this, &other).map(Value::Bool),
        "issuperset" => compare::holds(cx, Compare::GreaterEqual, &this, &other).map(Value::Bool),
        "union" => operators::binary(cx, Binary::BitOr, &this, &other),
        "intersection" => operators::binary(cx, Binary::BitAnd, &this, &other),
        "difference" => operators::binary(cx, Binary::Subtract, &this, &other),
        _ => operators::binary(cx, Binary::BitXor, &this, &other),
    }
}
