//! Types as functions: `int(…)`, `str(…)`, `list(…)`; and type tests.

use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::values::float;
use crate::expression::values::integer;
use crate::expression::values::kinds;
use crate::expression::values::kinds::{a_kind, as_float};
use crate::expression::values::reference::{Function, TYPES};
use crate::expression::values::repr;
use crate::expression::values::repr::text_of;
use crate::expression::values::value::Dictionary;
use crate::expression::values::value::{Progression, Value};
use crate::fault::{Fault, Result};
use num_traits::ToPrimitive;
use std::cell::RefCell;
use std::rc::Rc;

pub(crate) fn call(cx: &Evaluator, name: &'static str, mut arguments: Arguments) -> Result<Value> {
    match name {
        "dict" => return dictionary(cx, arguments),
        "int" => return int(arguments),
        "range" => return range(arguments),
        "isinstance" => {
            let [value, types] = arguments.exactly(name)?;
            return is_instance(&value, &types).map(Value::Bool);
        }
        "str" => {
            return match arguments.bound(name, ["object"], 0)? {
                [None] => Ok(Value::text("")),
                [Some(value)] => text_of(cx.host.budget(), &value).map(Value::text),
            };
        }
        _ => {}
    }
    // the others take at most one value
    let value = match arguments.positional.len() {
        0 if arguments.named.is_empty() => None,
        _ => {
            let [value] = Arguments::of(std::mem::take(&mut arguments.positional)).exactly(name)?;
            Some(value)
        }
    };
    arguments.only_positional(name)?;
    let items = |value: &Option<Value>| value.as_ref().map_or(Ok(Vec::new()), |value| cx.all_items(value));
    match (name, value) {
        ("float", None) => Ok(Value::Float(0.0)),
        ("float", Some(Value::Str(text))) => float::parse(&text)
            .map(Value::Float)
            .ok_or_else(|| Fault::new(format!("{} is not a number", repr::short(&Value::Str(text))))),
        ("float", Some(value)) => as_float(&value).map(Value::Float),
        ("bool", value) => Ok(Value::Bool(value.is_some_and(|value| value.truth()))),
        ("list", value) => Ok(Value::list(items(&value)?)),
        ("tuple", value) => Ok(Value::Tuple(items(&value)?.into())),
        ("set", value) => {
            let items = value.as_ref().map_or(Ok(Vec::new()), |value| cx.items_in_any_order(value))?;
            Ok(Value::Set(Rc::new(RefCell::new(Dictionary::of_keys(items)?))))
        }
        ("ord", Some(Value::Str(text))) => {
            let mut letters = text.chars();
            match (letters.next(), letters.next()) {
                (Some(c), None) => Ok(Value::int(c as u32)),
                _ => Err(Fault::new("expected one character")),
            }
        }
        ("repr", Some(value)) => repr::repr(cx.host.budget(), &value).map(Value::text),
        ("type", Some(value)) => match TYPES.iter().find(|known| **known == value.kind()) {
            Some(name) => Ok(Value::Function(Function { module: "python", name })),
            None => Err(Fault::new(format!("the type of {} is not supported", a_kind(&value)))),
        },
        ("ord", Some(other)) => Err(Fault::new(format!("expected a str, found {}", a_kind(&other)))),
        (_, None) => Err(Fault::new("called without an argument")),
        _ => Err(Fault::new(format!("the function `{name}` is not supported"))),
    }
}

fn int(arguments: Arguments) -> Result<Value> {
    match arguments.bound("int", ["", "base"], 0)? {
        [None, None] => Ok(Value::int(0)),
        [Some(Value::Str(text)), base] => {
            let base = base.map_or(Ok(10), |base| kinds::whole(&base, "a base"))?;
            if base != 0 && !(2..=36).contains(&base) {
                return Err(Fault::new(format!("the base is {base}, expected 0 or 2 to 36")));
            }
            let found = integer::parse(&text, base as u32).map(Value::Int);
            found.ok_or_else(|| Fault::new(format!("{} is not an int", repr::short(&Value::Str(text)))))
        }
        [Some(Value::Float(number)), None] => Ok(Value::Int(float::whole(number.trunc())?)),
        [Some(value), None] => {
            let found = value.as_int().map(Value::Int);
            found.ok_or_else(|| Fault::new(format!("expected a number or a str, found {}", a_kind(&value))))
        }
        _ => Err(Fault::new("a base needs a str before it")),
    }
}

fn range(arguments: Arguments) -> Result<Value> {
    let [first, second, step] = arguments.bound("range", [""; 3], 1)?;
    let whole = |value: &Value| match value.as_int() {
        Some(number) => number.to_i64().ok_or_else(|| Fault::new("a bound of more than 64 bits")),
        None => Err(Fault::new(format!("expected ints, found {}", a_kind(value)))),
    };
    let whole = |value: &Option<Value>| value.as_ref().map(whole).transpose();
    let (first, second, step) = (whole(&first)?.unwrap_or(0), whole(&second)?, whole(&step)?.unwrap_or(1));
    if step == 0 {
        return Err(Fault::new("the step is 0, expected another number"));
    }
    let (start, stop) = second.map_or((0, first), |stop| (first, stop));
    Ok(Value::Range(Progression { start, stop, step }))
}

fn dictionary(cx: &Evaluator, arguments: Arguments) -> Result<Value> {
    let mut entries = Dictionary::default();
    if arguments.positional.len() > 1 {
        return Err(Fault::new("`dict` is called with more than one argument without a name"));
    }
    if let Some(first) = arguments.positional.first() {
        extend(cx, &mut entries, first)?;
    }
    for (name, value) in arguments.named {
        entries.insert(Value::Str(name), value)?;
    }
    Ok(Value::dict(entries))
}

/// Adds the entries of a dict, or of pairs.
pub(crate) fn extend(cx: &Evaluator, entries: &mut Dictionary, from: &Value) -> Result<()> {
    if let Value::Dict(others, is_dotted) = from {
        cx.host.budget().items(others.borrow().len())?;
        for (key, value) in others.borrow().entries() {
            entries.insert(key.clone(), if *is_dotted { value.dotted() } else { value.clone() })?;
        }
        return Ok(());
    }
    for pair in cx.all_items(from)? {
        let Ok([key, value]) = <[Value; 2]>::try_from(cx.all_items(&pair)?) else {
            return Err(Fault::new("`dict` takes pairs of a key and a value"));
        };
        entries.insert(key, value)?;
    }
    Ok(())
}

fn is_instance(value: &Value, types: &Value) -> Result<bool> {
    match types {
        Value::Function(function) if function.is_type() => Ok(match function.name {
            "int" => matches!(value, Value::Int(_) | Value::Bool(_)),
            "list" => matches!(value, Value::List(..)),
            "dict" => matches!(value, Value::Dict(..)),
            name => value.kind() == name,
        }),
        Value::Tuple(types) => {
            for each in types.iter() {
                if is_instance(value, each)? {
                    return Ok(true);
                }
            }
            Ok(false)
        }
        other => Err(Fault::new(format!("`isinstance` takes a type, found {}", a_kind(other)))),
    }
}
