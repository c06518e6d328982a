//! Python's `math`: functions of ints and of rows of numbers.

use crate::bounds::MOST_BITS;
use crate::expression::library::math;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::operators::binary;
use crate::expression::syntax::Binary;
use crate::expression::values::integer;
use crate::expression::values::kinds;
use crate::expression::values::kinds::{a_kind, as_float};
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};

pub(crate) fn call(cx: &Evaluator, name: &str, mut arguments: Arguments) -> Option<Result<Value>> {
    let result = match name {
        "gcd" | "lcm" => arguments.only_positional(name).and_then(|values| {
            let join = |a: BigInt, b: BigInt| if name == "gcd" { a.gcd(&b) } else { a.lcm(&b) };
            let start = BigInt::from(if name == "gcd" { 0 } else { 1 });
            values.iter().try_fold(start, |a, b| integer::bounded(join(a, int(b)?).abs())).map(Value::Int)
        }),
        "factorial" => arguments.exactly(name).and_then(|[n]| {
            let n = size(&n)?;
            product(cx, (1..=n).map(BigInt::from))
        }),
        "comb" => arguments.exactly(name).and_then(|[n, k]| {
            if int(&k)? > int(&n)? && !int(&n)?.is_negative() {
                return Ok(Value::int(0));
            }
            let whole = int(&n)?;
            if whole.is_negative() {
                size(&n)?; // reports the error
            }
            // n over k equals n over n − k: the smaller one needs fewer steps
            let rest = Value::Int(&whole - int(&k)?);
            let k = if int(&rest)? < int(&k)? { size(&rest)? } else { size(&k)? };
            let mut result = BigInt::from(1);
            for i in 1..=k {
                cx.spend(1 + result.bits() / 64)?;
                result = integer::bounded(result * (&whole - k + i) / i)?;
            }
            Ok(Value::Int(result))
        }),
        "perm" => arguments.bound(name, ["", ""], 1).and_then(|[n, k]| {
            let n = size(&n.unwrap_or(Value::None))?;
            let k = k.filter(|k| !matches!(k, Value::None)).map_or(Ok(n), |k| size(&k))?;
            if k > n { Ok(Value::int(0)) } else { product(cx, (n - k + 1..=n).map(BigInt::from)) }
        }),
        "isqrt" => arguments.exactly(name).and_then(|[n]| {
            let n = int(&n)?;
            if n.is_negative() { Err(Fault::new(format!("{n} is negative"))) } else { Ok(Value::Int(n.sqrt())) }
        }),
        "ldexp" => arguments.exactly(name).and_then(|[x, exponent]| {
            let exponent = kinds::whole(&exponent, "an exponent")?.clamp(-5000, 5000);
            match libm::ldexp(as_float(&x)?, exponent as i32) {
                result if result.is_infinite() && as_float(&x)?.is_finite() => {
                    Err(Fault::new("the result is too large for a float"))
                }
                result => Ok(Value::Float(result)),
            }
        }),
        "prod" => {
            let start = arguments.take("start").unwrap_or_else(|| Value::int(1));
            arguments.exactly(name).and_then(|[items]| {
                let items = cx.all_items(&items)?;
                items.iter().try_fold(start, |a, b| binary(cx, Binary::Multiply, &a, b))
            })
        }
        "fsum" => arguments.exactly(name).and_then(|[items]| {
            let numbers = cx.all_items(&items)?.iter().map(as_float).collect::<Result<Vec<_>>>()?;
            exact_sum(&numbers).map(Value::Float)
        }),
        "dist" => arguments.exactly(name).and_then(|[p, q]| {
            let (p, q) = (cx.all_items(&p)?, cx.all_items(&q)?);
            if p.len() != q.len() {
                return Err(Fault::new(format!("points of {} and {} coordinates", p.len(), q.len())));
            }
            let difference = |(a, b): (&Value, &Value)| Ok(as_float(a)? - as_float(b)?);
            Ok(Value::Float(math::norm(&p.iter().zip(&q).map(difference).collect::<Result<Vec<_>>>()?)))
        }),
        "isclose" => is_close(arguments),
        // a function of floats that was called with a keyword argument
        _ => return Some(Err(Fault::new(format!("`{name}` takes no arguments by name")))),
    };
    Some(result)
}

fn int(value: &Value) -> Result<BigInt> {
    value.as_int().ok_or_else(|| Fault::new(format!("expected an int, found {}", a_kind(value))))
}

/// A number that is not negative, and small enough to iterate up to.
fn size(value: &Value) -> Result<u64> {
    let number = int(value)?;
    match number.to_u64().filter(|n| *n <= 1 << 32) {
        Some(n) => Ok(n),
        None if number.is_negative() => Err(Fault::new(format!("{number} is negative"))),
        None => Err(Fault::new(format!("an int of more than {MOST_BITS} bits"))),
    }
}

fn product(cx: &Evaluator, mut factors: impl Iterator<Item = BigInt>) -> Result<Value> {
    let result = factors.try_fold(BigInt::from(1), |product, factor| {
        cx.spend(1 + product.bits() / 64)?;
        integer::bounded(product * factor)
    })?;
    Ok(Value::Int(result))
}

/// The sum of floats, rounded once (Shewchuk 1997): partial sums that do not overlap.
fn exact_sum(numbers: &[f64]) -> Result<f64> {
    if let Some(odd) = numbers.iter().find(|x| !x.is_finite()) {
        let sum: f64 = numbers.iter().filter(|x| !x.is_finite()).sum();
        return if sum.is_nan() && !odd.is_nan() { Err(Fault::new("inf and -inf have no sum")) } else { Ok(sum) };
    }
    // each number is an integer multiple of 2⁻¹⁰⁷⁴
    let mut sum = BigInt::zero();
    for &x in numbers {
        let (mantissa, exponent) = libm::frexp(x);
        let whole = BigInt::from((mantissa * (1u64 << 53) as f64) as i64);
        let shift = i64::from(exponent) - 53 + 1074;
        sum += if shift >= 0 { whole << shift } else { whole >> -shift };
    }
    integer::divide(&sum, &(BigInt::from(1) << 1074))
}

fn is_close(mut arguments: Arguments) -> Result<Value> {
    let tolerance = |value: Option<Value>, default: f64| match value.map_or(Ok(default), |value| as_float(&value))? {
        tolerance if tolerance < 0.0 => Err(Fault::new("a tolerance below 0")),
        tolerance => Ok(tolerance),
    };
    let relative = tolerance(arguments.take("rel_tol"), 1e-9)?;
    let absolute = tolerance(arguments.take("abs_tol"), 0.0)?;
    let [a, b] = arguments.bound("isclose", ["a", "b"], 2)?.map(|value| value.unwrap_or(Value::None));
    let (a, b) = (as_float(&a)?, as_float(&b)?);
    let difference = (b - a).abs();
    let within = difference <= (relative * b).abs() || difference <= (relative * a).abs() || difference <= absolute;
    Ok(Value::Bool(a == b || a.is_finite() && b.is_finite() && within))
}
