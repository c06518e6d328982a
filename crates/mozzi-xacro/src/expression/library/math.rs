//! Python's `math`: functions of floats.

use crate::expression::library::gamma;
use crate::expression::operations::arguments::Arguments;
use crate::expression::values::float;
use crate::expression::values::kinds::as_float;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};

/// The function of this name, if it takes only positional floats.
pub(crate) fn call(name: &str, arguments: &Arguments) -> Option<Result<Value>> {
    let values = &arguments.positional;
    if !arguments.named.is_empty() {
        return None;
    }
    let count = |expected: usize| match values.len() {
        count if count == expected => Ok(()),
        count => Err(Fault::new(format!("`{name}` is called with {count} arguments, expected {expected}"))),
    };
    if let Some(function) = of_one(name) {
        return Some(count(1).and_then(|()| as_float(&values[0])).and_then(|x| function(x).map(Value::Float)));
    }
    if let Some(function) = of_two(name) {
        let pair = count(2).and_then(|()| Ok((as_float(&values[0])?, as_float(&values[1])?)));
        return Some(pair.and_then(|(a, b)| function(a, b).map(Value::Float)));
    }
    let test = match name {
        "isfinite" => f64::is_finite,
        "isinf" => f64::is_infinite,
        "isnan" => f64::is_nan,
        "floor" | "ceil" | "trunc" => return Some(count(1).and_then(|()| rounded(name, &values[0]))),
        "modf" | "frexp" => return Some(count(1).and_then(|()| as_float(&values[0])).map(|x| split(name, x))),
        "log" => return Some(logarithm(values)),
        "hypot" => {
            let coordinates = values.iter().map(as_float).collect::<Result<Vec<_>>>();
            return Some(coordinates.map(|coordinates| Value::Float(norm(&coordinates))));
        }
        _ => return None,
    };
    Some(count(1).and_then(|()| as_float(&values[0])).map(|x| Value::Bool(test(x))))
}

type OfOne = fn(f64) -> Result<f64>;
type OfTwo = fn(f64, f64) -> Result<f64>;

fn domain(x: f64) -> Box<Fault> {
    Fault::new(format!("{} is outside of its domain", float::repr(x)))
}

fn overflow(x: f64) -> Box<Fault> {
    Fault::new(format!("its value at {} is too large for a float", float::repr(x)))
}

/// The error for a result that is NaN or infinite although the arguments are finite.
fn checked(x: f64, result: f64, may_overflow: bool) -> Result<f64> {
    match result {
        result if result.is_nan() && !x.is_nan() => Err(domain(x)),
        result if result.is_infinite() && x.is_finite() => Err(if may_overflow { overflow(x) } else { domain(x) }),
        result => Ok(result),
    }
}

fn of_one(name: &str) -> Option<OfOne> {
    Some(match name {
        "acos" => |x| checked(x, x.acos(), false),
        "acosh" => |x| checked(x, libm::acosh(x), false),
        "asin" => |x| checked(x, x.asin(), false),
        "asinh" => |x| checked(x, libm::asinh(x), false),
        "atan" => |x| Ok(x.atan()),
        "atanh" => |x| checked(x, libm::atanh(x), false),
        "cbrt" => |x| Ok(x.cbrt()),
        "cos" => |x| checked(x, x.cos(), false),
        "cosh" => |x| checked(x, x.cosh(), true),
        "degrees" => |x| Ok(x * (180.0 / std::f64::consts::PI)),
        "erf" => |x| Ok(libm::erf(x)),
        "erfc" => |x| Ok(libm::erfc(x)),
        "exp" => |x| checked(x, x.exp(), true),
        "exp2" => |x| checked(x, x.exp2(), true),
        "expm1" => |x| checked(x, x.exp_m1(), true),
        "fabs" => |x| Ok(x.abs()),
        "gamma" => gamma::gamma,
        "lgamma" => gamma::log_gamma,
        "log10" => |x| if x <= 0.0 { Err(domain(x)) } else { Ok(x.log10()) },
        "log1p" => |x| checked(x, x.ln_1p(), false),
        "log2" => |x| if x <= 0.0 { Err(domain(x)) } else { Ok(x.log2()) },
        "radians" => |x| Ok(x * (std::f64::consts::PI / 180.0)),
        "sin" => |x| checked(x, x.sin(), false),
        "sinh" => |x| checked(x, x.sinh(), true),
        "sqrt" => |x| checked(x, x.sqrt(), false),
        "tan" => |x| checked(x, x.tan(), false),
        "tanh" => |x| Ok(x.tanh()),
        "ulp" => |x| Ok(ulp(x)),
        _ => return None,
    })
}

fn of_two(name: &str) -> Option<OfTwo> {
    Some(match name {
        "atan2" => |y, x| Ok(y.atan2(x)),
        "copysign" => |x, y| Ok(x.copysign(y)),
        "fmod" => |x, y| match x % y {
            rest if rest.is_nan() && !x.is_nan() && !y.is_nan() => Err(domain(if y == 0.0 { y } else { x })),
            rest => Ok(rest),
        },
        "nextafter" => |x, y| Ok(next_after(x, y)),
        "pow" => |x, y| match x.powf(y) {
            result if result.is_nan() && !x.is_nan() && !y.is_nan() => Err(domain(x)),
            result if result.is_infinite() && x.is_finite() && y.is_finite() => {
                Err(if x == 0.0 { domain(x) } else { overflow(x) })
            }
            result => Ok(result),
        },
        "remainder" => |x, y| match libm::remainder(x, y) {
            rest if rest.is_nan() && !x.is_nan() && !y.is_nan() => Err(domain(if y == 0.0 { y } else { x })),
            rest => Ok(rest),
        },
        _ => return None,
    })
}

/// The integer value of a float without a fraction.
pub(crate) fn to_int(number: f64) -> Result<Value> {
    if number.is_finite() {
        return float::whole(number).map(Value::Int);
    }
    Err(Fault::new(format!("{} has no whole number", float::repr(number))))
}

fn rounded(name: &str, value: &Value) -> Result<Value> {
    if let Some(number) = value.as_int() {
        return Ok(Value::Int(number));
    }
    let x = as_float(value)?;
    to_int(match name {
        "floor" => x.floor(),
        "ceil" => x.ceil(),
        _ => x.trunc(),
    })
}

fn split(name: &str, x: f64) -> Value {
    if name == "modf" {
        let whole = x.trunc();
        let part = if x.is_infinite() { 0.0f64.copysign(x) } else { (x - whole).copysign(x) };
        return Value::Tuple([Value::Float(part), Value::Float(whole)].into());
    }
    let (mantissa, exponent) = if x.is_finite() { libm::frexp(x) } else { (x, 0) };
    Value::Tuple([Value::Float(mantissa), Value::int(exponent)].into())
}

fn logarithm(values: &[Value]) -> Result<Value> {
    let ln = |value: &Value| {
        let x = as_float(value)?;
        if x <= 0.0 { Err(domain(x)) } else { Ok(x.ln()) }
    };
    match values {
        [value] => ln(value).map(Value::Float),
        [value, base] => match (ln(value)?, ln(base)?) {
            (_, 0.0) => Err(Fault::new("the base is 1, expected another number")),
            (value, base) => Ok(Value::Float(value / base)),
        },
        _ => Err(Fault::new(format!("`log` is called with {} arguments, expected 1 or 2", values.len()))),
    }
}

/// √Σx², scaled so that nothing overflows.
pub(crate) fn norm(coordinates: &[f64]) -> f64 {
    if coordinates.iter().any(|x| x.is_infinite()) {
        return f64::INFINITY;
    }
    if let [a, b] = coordinates {
        return a.hypot(*b);
    }
    let largest = coordinates.iter().fold(0.0f64, |most, x| if x.is_nan() { *x } else { most.max(x.abs()) });
    if coordinates.iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    if largest == 0.0 {
        return 0.0;
    }
    largest * coordinates.iter().map(|x| (x / largest) * (x / largest)).sum::<f64>().sqrt()
}

fn ulp(x: f64) -> f64 {
    let x = x.abs();
    match x {
        x if !x.is_finite() => x,
        f64::MAX => f64::MAX - f64::MAX.next_down(),
        x => x.next_up() - x,
    }
}

fn next_after(x: f64, y: f64) -> f64 {
    match x.partial_cmp(&y) {
        None => f64::NAN,
        Some(std::cmp::Ordering::Equal) => y,
        Some(std::cmp::Ordering::Less) => x.next_up(),
        Some(std::cmp::Ordering::Greater) => x.next_down(),
    }
}
