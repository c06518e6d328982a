//! Integers of any size, up to a bound.

use crate::bounds::{MOST_BITS, MOST_DIGITS};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

/// A number within the bound on its size.
pub(crate) fn bounded(number: BigInt) -> Result<BigInt> {
    if number.bits() > MOST_BITS { Err(too_large(number.bits())) } else { Ok(number) }
}

fn too_large(bits: u64) -> Box<Fault> {
    Fault::new(format!("an int of {bits} bits, expected at most {MOST_BITS}"))
}

/// `base ** exponent` for an exponent ≥ 0.
pub(crate) fn power(base: &BigInt, exponent: &BigInt) -> Result<BigInt> {
    let is_small = base.bits() <= 1; // 0, 1 and -1
    if is_small {
        let is_odd = exponent.bit(0);
        return Ok(match () {
            () if exponent.is_zero() => BigInt::from(1),
            () if base.is_negative() && !is_odd => BigInt::from(1),
            () => base.clone(),
        });
    }
    let bits = exponent.to_u64().and_then(|exponent| (base.bits() - 1).checked_mul(exponent));
    match (bits, exponent.to_u32()) {
        (Some(bits), Some(exponent)) if bits <= MOST_BITS => bounded(base.pow(exponent)),
        (bits, _) => Err(too_large(bits.unwrap_or(u64::MAX))),
    }
}

/// The nearest float.
pub(crate) fn to_float(number: &BigInt) -> Result<f64> {
    number
        .to_f64()
        .filter(|float| float.is_finite())
        .ok_or_else(|| Fault::new("the int is too large for a float, expected at most 1.8e308"))
}

/// a / b as a float, rounded once.
pub(crate) fn divide(a: &BigInt, b: &BigInt) -> Result<f64> {
    const EXACT: u64 = 53;
    if a.bits() <= EXACT && b.bits() <= EXACT {
        return Ok(a.to_f64().unwrap_or(f64::NAN) / b.to_f64().unwrap_or(f64::NAN));
    }
    // a quotient of at least 66 bits, whose last bit is set if there is a remainder, is rounded like the exact one
    let shift = (66 + b.bits() as i64 - a.bits() as i64).max(0) as u64;
    let (numerator, denominator) = (a.abs() << shift, b.abs());
    let (mut quotient, remainder) = (&numerator / &denominator, &numerator % &denominator);
    if !remainder.is_zero() {
        quotient.set_bit(0, true);
    }
    let size = scaled(&quotient, -(shift as i64))?;
    Ok(if a.is_negative() == b.is_negative() { size } else { -size })
}

/// number · 2^exponent, correctly rounded for normal results.
fn scaled(number: &BigInt, exponent: i64) -> Result<f64> {
    let extra = number.bits().saturating_sub(66);
    let mut top = number >> extra;
    if (&top << extra) != *number {
        top.set_bit(0, true);
    }
    let exponent = exponent + extra as i64;
    let (bits, mantissa) = (top.bits() as i64, top.to_f64().unwrap_or(f64::NAN));
    if exponent + bits > 1024 {
        return Err(Fault::new("the quotient is too large for a float"));
    }
    if exponent + bits < -1080 {
        return Ok(0.0);
    }
    // in two steps; only the last one can overflow or round
    let half = exponent / 2;
    Ok(mantissa * 2f64.powi(half as i32) * 2f64.powi((exponent - half) as i32))
}

/// The decimal digits; refused if there are more than Python prints.
pub(crate) fn text(number: &BigInt) -> Result<String> {
    let text = number.to_string();
    let digits = text.trim_start_matches('-').len();
    if digits > MOST_DIGITS {
        return Err(Fault::new(format!("an int of {digits} digits, expected at most {MOST_DIGITS}")));
    }
    Ok(text)
}

/// Reads a number as `int("…")` does: white space around it, a sign, single underscores between digits.
pub(crate) fn parse(text: &str, radix: u32) -> Option<BigInt> {
    let text = text.trim_matches(crate::space::is_space);
    let (is_negative, digits) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let prefix = |letters: [&str; 2]| letters.iter().find_map(|letter| digits.strip_prefix(letter));
    let (digits, radix, has_prefix) = match radix {
        0 | 16 if prefix(["0x", "0X"]).is_some() => (prefix(["0x", "0X"])?, 16, true),
        0 | 8 if prefix(["0o", "0O"]).is_some() => (prefix(["0o", "0O"])?, 8, true),
        0 | 2 if prefix(["0b", "0B"]).is_some() => (prefix(["0b", "0B"])?, 2, true),
        0 if digits.len() > 1 && digits.starts_with('0') && digits.bytes().any(|b| !matches!(b, b'0' | b'_')) => None?,
        0 => (digits, 10, false),
        radix => (digits, radix, false),
    };
    let digits = if has_prefix { digits.strip_prefix('_').unwrap_or(digits) } else { digits };
    let is_row = !digits.is_empty()
        && !digits.starts_with('_')
        && !digits.ends_with('_')
        && !digits.contains("__")
        && digits.chars().all(|c| c == '_' || c.is_digit(radix));
    if !is_row || digits.len() > MOST_DIGITS {
        return None;
    }
    let plain: Vec<u8> = digits.bytes().filter(|b| *b != b'_').collect();
    let size = BigInt::parse_bytes(&plain, radix)?;
    Some(if is_negative { -size } else { size })
}
