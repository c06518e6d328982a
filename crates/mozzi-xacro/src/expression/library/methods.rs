//! Methods and attributes of values.

use crate::expression::library::dict_methods;
use crate::expression::library::function;
use crate::expression::library::list_methods;
use crate::expression::library::string_methods;
use crate::expression::library::string_split;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::values::float;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_traits::Signed;
use std::rc::Rc;

/// True if the value has this method.
pub(crate) fn has(of: &Value, name: &str) -> bool {
    match of {
        Value::Str(_) => string_methods::NAMES.contains(&name) || string_split::NAMES.contains(&name),
        Value::List(..) => list_methods::NAMES.contains(&name),
        Value::Tuple(_) | Value::Range(_) => ["count", "index"].contains(&name),
        Value::Dict(..) => dict_methods::NAMES.contains(&name),
        Value::Set(_) => dict_methods::SET_NAMES.contains(&name),
        Value::Int(_) | Value::Bool(_) => ["bit_length", "bit_count", "conjugate"].contains(&name),
        Value::Float(_) => ["is_integer", "hex", "conjugate"].contains(&name),
        _ => false,
    }
}

/// `value.name`: a method, an item of a dictionary from YAML, a property of a namespace.
pub(crate) fn attribute(cx: &Evaluator, of: &Value, name: &Rc<str>) -> Result<Value> {
    if has(of, name) {
        return Ok(Value::Method(Rc::new((of.clone(), name.clone()))));
    }
    let missing = || Err(Fault::new(format!("{} has no attribute `{name}`", a_kind(of))));
    match of {
        Value::Dict(entries, true) => match entries.borrow().text_key(name) {
            Some(value) => Ok(value.dotted()),
            None => Err(Fault::new(format!("the YAML dict has no key `{name}`"))),
        },
        Value::Namespace(scope) => match cx.host.member(scope, name)? {
            Some(value) => Ok(value),
            None => Err(Fault::new(format!("the namespace has no property `{name}`"))),
        },
        Value::Module(module) => match function::member(module, name) {
            Some(value) => Ok(value),
            None => Err(Fault::new(format!("`{module}` has no function `{name}`"))),
        },
        Value::Int(_) | Value::Bool(_) => match (&**name, of.as_int()) {
            ("real" | "numerator", Some(number)) => Ok(Value::Int(number)),
            ("imag", _) => Ok(Value::int(0)),
            ("denominator", _) => Ok(Value::int(1)),
            _ => missing(),
        },
        Value::Float(number) => match &**name {
            "real" => Ok(Value::Float(*number)),
            "imag" => Ok(Value::Float(0.0)),
            _ => missing(),
        },
        // `str.upper` and the like, for `map`
        Value::Function(function) if function.name == "str" && function.module == "python" => {
            match has(&Value::text(""), name) {
                true => Ok(Value::Method(Rc::new((of.clone(), name.clone())))),
                false => missing(),
            }
        }
        Value::Range(range) => match &**name {
            "start" => Ok(Value::int(range.start)),
            "stop" => Ok(Value::int(range.stop)),
            "step" => Ok(Value::int(range.step)),
            _ => missing(),
        },
        _ => missing(),
    }
}

/// Calls a method that the value [`has`].
pub(crate) fn call(cx: &Evaluator, of: &Value, name: &str, mut arguments: Arguments) -> Result<Value> {
    cx.spend(1)?;
    match of {
        Value::Str(text) if string_split::NAMES.contains(&name) => string_split::call(cx, text, name, arguments),
        Value::Str(text) => string_methods::call(cx, text, name, arguments),
        Value::List(items, _) => list_methods::call(cx, items, name, arguments),
        Value::Tuple(_) | Value::Range(_) => {
            let items = cx.all_items(of)?;
            list_methods::search(cx, &items, name, arguments)
        }
        Value::Dict(entries, _) => dict_methods::call(cx, entries, name, arguments),
        Value::Set(entries) => dict_methods::call_set(cx, entries, name, arguments),
        Value::Function(_) if !arguments.positional.is_empty() => {
            let receiver = arguments.positional.remove(0);
            match receiver {
                Value::Str(_) => call(cx, &receiver, name, arguments),
                other => Err(Fault::new(format!("`str.{name}` takes a str, found {}", a_kind(&other)))),
            }
        }
        Value::Float(number) => {
            arguments.bound(name, [], 0)?;
            match name {
                "is_integer" => Ok(Value::Bool(number.is_finite() && number.fract() == 0.0)),
                "conjugate" => Ok(of.clone()),
                _ => Err(Fault::new(format!("`{name}` of a float is not supported: {}", float::repr(*number)))),
            }
        }
        _ => {
            arguments.bound(name, [], 0)?;
            let number = of.as_int().unwrap_or_default();
            Ok(match name {
                "bit_length" => Value::int(number.bits()),
                "bit_count" => Value::int(number.abs().magnitude().count_ones()),
                _ => Value::Int(number),
            })
        }
    }
}
