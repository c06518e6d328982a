//! The functions and constants available to expressions.

use crate::expression::library::aggregate;
use crate::expression::library::math;
use crate::expression::library::math_integer;
use crate::expression::library::types;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::values::reference::Function;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};

/// The builtins that need no `python.`
const BARE: [&str; 13] =
    ["list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round", "sorted", "range"];
const PYTHON: [&str; 32] = [
    "list",
    "dict",
    "map",
    "len",
    "str",
    "float",
    "int",
    "bool",
    "min",
    "max",
    "round",
    "sorted",
    "range",
    "abs",
    "all",
    "any",
    "complex",
    "divmod",
    "enumerate",
    "filter",
    "frozenset",
    "hash",
    "isinstance",
    "issubclass",
    "ord",
    "repr",
    "reversed",
    "set",
    "sum",
    "tuple",
    "type",
    "zip",
];
const MATH: [&str; 55] = [
    "acos",
    "acosh",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "cbrt",
    "ceil",
    "comb",
    "copysign",
    "cos",
    "cosh",
    "degrees",
    "dist",
    "erf",
    "erfc",
    "exp",
    "exp2",
    "expm1",
    "fabs",
    "factorial",
    "floor",
    "fmod",
    "frexp",
    "fsum",
    "gamma",
    "gcd",
    "hypot",
    "isclose",
    "isfinite",
    "isinf",
    "isnan",
    "isqrt",
    "lcm",
    "ldexp",
    "lgamma",
    "log",
    "log10",
    "log1p",
    "log2",
    "modf",
    "nextafter",
    "perm",
    "pow",
    "prod",
    "radians",
    "remainder",
    "sin",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
    "trunc",
    "ulp",
];
const CONSTANTS: [(&str, f64); 5] = [
    ("pi", std::f64::consts::PI),
    ("e", std::f64::consts::E),
    ("tau", std::f64::consts::TAU),
    ("inf", f64::INFINITY),
    ("nan", f64::NAN),
];
const XACRO: [&str; 10] = [
    "load_yaml",
    "abs_filename",
    "dotify",
    "arg",
    "message",
    "warning",
    "error",
    "print_location",
    "fatal",
    "tokenize",
];
/// The meaning of a name that no property has.
pub(crate) fn global(name: &str) -> Option<Value> {
    let function = |module, names: &[&'static str]| {
        names.iter().find(|known| **known == name).map(|name| Value::Function(Function { module, name }))
    };
    match name {
        "math" => return Some(Value::Module("math")),
        "python" => return Some(Value::Module("python")),
        "xacro" => return Some(Value::Module("xacro")),
        _ => {}
    }
    function("python", &BARE)
        .or_else(|| function("math", &MATH))
        .or_else(|| function("xacro", &XACRO[..3]))
        .or_else(|| constant(name))
}

fn constant(name: &str) -> Option<Value> {
    CONSTANTS.iter().find(|(known, _)| *known == name).map(|(_, number)| Value::Float(*number))
}

pub(crate) fn module_has(module: &str, name: &str) -> bool {
    member(module, name).is_some()
}

/// `math.sin`, `python.sum`, `xacro.load_yaml`.
pub(crate) fn member(module: &str, name: &str) -> Option<Value> {
    let find = |module, names: &[&'static str]| {
        names.iter().find(|known| **known == name).map(|name| Value::Function(Function { module, name }))
    };
    match module {
        "math" => find("math", &MATH).or_else(|| constant(name)),
        "python" => find("python", &PYTHON),
        _ => find("xacro", &XACRO),
    }
}

pub(crate) fn call(cx: &Evaluator, function: Function, arguments: Arguments) -> Result<Value> {
    let found = match function.module {
        "math" => math::call(function.name, &arguments)
            .or_else(|| math_integer::call(cx, function.name, arguments))
            .unwrap_or_else(|| Err(unsupported(function))),
        "xacro" => return xacro(cx, function.name, arguments),
        _ if aggregate::NAMES.contains(&function.name) => aggregate::call(cx, function.name, arguments),
        _ => types::call(cx, function.name, arguments),
    };
    found.map_err(|mut fault| {
        if !fault.message.contains('`') {
            fault.message = format!("`{}`: {}", function.name, fault.message);
        }
        fault
    })
}

pub(crate) fn unsupported(function: Function) -> Box<Fault> {
    Fault::new(format!("the function `{}` is not supported", function.name))
}

/// The functions of xacro itself.
fn xacro(cx: &Evaluator, name: &'static str, arguments: Arguments) -> Result<Value> {
    let text = |value: &Value| match value {
        Value::Str(text) => Ok(text.clone()),
        other => {
            Err(Fault::new(format!("`{name}` takes a str, found {}", crate::expression::values::kinds::a_kind(other))))
        }
    };
    match name {
        "load_yaml" => {
            let [file] = arguments.bound(name, ["filename"], 1)?.map(|value| value.unwrap_or(Value::None));
            cx.host.load_yaml(&text(&file)?)
        }
        "abs_filename" => {
            let [file] = arguments.bound(name, ["filename_spec"], 1)?.map(|value| value.unwrap_or(Value::None));
            Ok(Value::text(cx.host.absolute(&text(&file)?)))
        }
        "dotify" => match arguments.exactly(name)? {
            [value @ Value::Dict(..)] => Ok(value.dotted()),
            [other] => Err(Fault::new(format!(
                "`dotify` takes a dict, found {}",
                crate::expression::values::kinds::a_kind(&other)
            ))),
        },
        "arg" => {
            let [key] = arguments.bound(name, ["name"], 1)?.map(|value| value.unwrap_or(Value::None));
            let key = text(&key)?;
            let found = cx.host.argument(&key).map(Value::Str);
            found.ok_or_else(|| Fault::new(format!("the argument `{key}` is not given and has no default")))
        }
        "tokenize" => tokenize(cx, arguments),
        "print_location" => Ok(Value::text("")),
        "fatal" => Err(Fault::new(joined(cx, &arguments.only_positional(name)?)?)),
        _ => {
            let message = joined(cx, &arguments.positional)?;
            cx.host.message(name, message);
            Ok(Value::text(""))
        }
    }
}

fn joined(cx: &Evaluator, values: &[Value]) -> Result<String> {
    let texts = values
        .iter()
        .map(|value| crate::expression::values::repr::text_of(cx.host.budget(), value))
        .collect::<Result<Vec<_>>>()?;
    Ok(texts.join(" "))
}

/// `xacro.tokenize(text, sep=',; ', skip_empty=True)`: the parts between the separators.
fn tokenize(cx: &Evaluator, arguments: Arguments) -> Result<Value> {
    let [text, separators, skip] = arguments.bound("tokenize", ["s", "sep", "skip_empty"], 1)?;
    let (Some(Value::Str(text)), None | Some(Value::Str(_))) = (&text, &separators) else {
        return Err(Fault::new("`tokenize` takes a str and separators"));
    };
    let separators = separators.as_ref().and_then(Value::as_text).map_or(",; ", |s| s);
    if separators.is_empty() || separators.contains(['\\', '-', '[', ']', '^']) {
        return Err(Fault::new(format!(
            "`tokenize`: the separators `{separators}` are not supported, expected plain characters"
        )));
    }
    let skips = skip.is_none_or(|skip| skip.truth());
    cx.host.budget().items(text.len())?;
    let parts = text.split(|c| separators.contains(c)).filter(|part| !skips || !part.is_empty());
    Ok(Value::list(parts.map(Value::text).collect()))
}
