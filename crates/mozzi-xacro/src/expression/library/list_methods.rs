//! Methods of lists.

use crate::bounds::MOST_ITEMS;
use crate::expression::library::aggregate;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::compare;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::index;
use crate::expression::values::kinds;
use crate::expression::values::repr;
use crate::expression::values::value::{Elements, Value};
use crate::fault::{Fault, Result};

pub(crate) const NAMES: [&str; 11] =
    ["append", "clear", "copy", "count", "extend", "index", "insert", "pop", "remove", "reverse", "sort"];

pub(crate) fn call(cx: &Evaluator, list: &Elements, name: &str, mut arguments: Arguments) -> Result<Value> {
    let count = list.borrow().len();
    cx.spend(1 + count as u64 / 64)?;
    match name {
        "append" => {
            let [item] = arguments.exactly(name)?;
            grow(cx, list, vec![item])?;
        }
        "extend" => {
            let [items] = arguments.exactly(name)?;
            grow(cx, list, cx.all_items(&items)?)?;
        }
        "insert" => {
            let [at, item] = arguments.exactly(name)?;
            let at = kinds::whole(&at, "`insert`")?;
            let at = if at < 0 { at.saturating_add(count as i64).max(0) } else { at.min(count as i64) };
            if count >= MOST_ITEMS {
                cx.host.budget().items(count + 1)?;
            }
            list.borrow_mut().insert(at as usize, item);
        }
        "pop" => {
            let [at] = arguments.bound(name, [""], 0)?;
            let at = index::place(&at.unwrap_or_else(|| Value::int(-1)), count, "list")?;
            return Ok(list.borrow_mut().remove(at));
        }
        "remove" => {
            let [item] = arguments.exactly(name)?;
            let at = position(cx, &list.borrow(), &item, 0)?;
            list.borrow_mut().remove(at);
        }
        "reverse" => {
            arguments.bound(name, [], 0)?;
            list.borrow_mut().reverse();
        }
        "clear" => {
            arguments.bound(name, [], 0)?;
            list.borrow_mut().clear();
        }
        "copy" => {
            arguments.bound(name, [], 0)?;
            cx.host.budget().items(count)?;
            return Ok(Value::list(list.borrow().clone()));
        }
        "sort" => {
            let (key, reverse) = (arguments.take("key"), arguments.take("reverse"));
            arguments.bound(name, [], 0)?;
            let items = list.borrow().clone();
            let sorted = aggregate::sort(cx, items, key.as_ref(), reverse.is_some_and(|reverse| reverse.truth()))?;
            *list.borrow_mut() = sorted;
        }
        _ => {
            let items = list.borrow().clone();
            return search(cx, &items, name, arguments);
        }
    }
    Ok(Value::None)
}

fn grow(cx: &Evaluator, list: &Elements, items: Vec<Value>) -> Result<()> {
    let count = list.borrow().len() + items.len();
    if count > MOST_ITEMS {
        cx.host.budget().items(count)?;
    }
    list.borrow_mut().extend(items);
    Ok(())
}

fn position(cx: &Evaluator, items: &[Value], wanted: &Value, from: usize) -> Result<usize> {
    for (k, item) in items.iter().enumerate().skip(from) {
        if compare::equal(cx, item, wanted)? {
            return Ok(k);
        }
    }
    Err(Fault::new(format!("{} is not in it", repr::short(wanted))))
}

/// `count` and `index`, also of tuples.
pub(crate) fn search(cx: &Evaluator, items: &[Value], name: &str, arguments: Arguments) -> Result<Value> {
    if name == "index" {
        let [item, start, stop] = arguments.bound(name, [""; 3], 1)?;
        let clip = |value: Option<Value>, default: usize| match value {
            None => Ok::<usize, Box<Fault>>(default),
            Some(value) => {
                let at = kinds::whole(&value, "`index`")?;
                let at = if at < 0 { at.saturating_add(items.len() as i64).max(0) } else { at };
                Ok((at as usize).min(items.len()))
            }
        };
        let (start, stop) = (clip(start, 0)?, clip(stop, items.len())?);
        return position(cx, &items[..stop], &item.unwrap_or(Value::None), start).map(Value::int);
    }
    let [wanted] = arguments.exactly(name)?;
    let mut count = 0;
    for item in items {
        count += usize::from(compare::equal(cx, item, &wanted)?);
    }
    Ok(Value::int(count))
}
