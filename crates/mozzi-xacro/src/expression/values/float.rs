//! Reads and prints floats as Python does.

use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_traits::FromPrimitive;

/// The shortest text that round-trips: `0.1`, `1e-05`, `1e+16`, `-0.0`, `inf`.
pub(crate) fn repr(number: f64) -> String {
    if !number.is_finite() {
        return if number.is_nan() {
            "nan".into()
        } else if number > 0.0 {
            "inf".into()
        } else {
            "-inf".into()
        };
    }
    let written = format!("{number:e}");
    let Some((mantissa, exponent)) = written.split_once('e') else { return written };
    let exponent: i32 = exponent.parse().unwrap_or_default();
    if (-4..16).contains(&exponent) {
        let plain = format!("{number}");
        return if plain.contains('.') { plain } else { plain + ".0" };
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}e{sign}{:02}", exponent.abs())
}

/// Reads a number as `float("…")` does.
pub(crate) fn parse(text: &str) -> Option<f64> {
    let text = text.trim_matches(crate::space::is_space);
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let is_word = ["inf", "infinity", "nan"].iter().any(|word| unsigned.eq_ignore_ascii_case(word));
    let is_number = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && unsigned.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'+' | b'-' | b'_'));
    if !is_word && !is_number {
        return None;
    }
    // underscores are allowed between digits only
    let bytes = unsigned.as_bytes();
    let is_digit = |at: Option<usize>| at.and_then(|at| bytes.get(at)).is_some_and(u8::is_ascii_digit);
    let underscores = || bytes.iter().enumerate().filter(|(_, b)| **b == b'_');
    if !underscores().all(|(at, _)| is_digit(at.checked_sub(1)) && is_digit(Some(at + 1))) {
        return None;
    }
    text.replace('_', "").parse().ok()
}

/// The whole number of a float without a fraction.
pub(crate) fn whole(number: f64) -> Result<BigInt> {
    BigInt::from_f64(number).ok_or_else(|| Fault::new(format!("{} is not a whole number", repr(number))))
}

/// `round(number, digits)`: the nearest number with this many decimals, ties to even, by the exact decimal digits.
pub(crate) fn round(number: f64, digits: i64) -> Result<f64> {
    if !number.is_finite() || number == 0.0 || digits > 330 {
        return Ok(number);
    }
    if digits < -310 {
        return Ok(0.0f64.copysign(number));
    }
    let rounded = if digits >= 0 {
        format!("{number:.*}", digits as usize).parse().unwrap_or(number)
    } else {
        let exponent: i64 = format!("{number:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or_default();
        match exponent + 1 + digits {
            // one place before the first digit: more than half of the unit rounds up, exactly half rounds to 0
            0 => {
                let half = format!("5e{exponent}").parse().unwrap_or(f64::INFINITY);
                let unit: f64 = format!("1e{}", exponent + 1).parse().unwrap_or(f64::INFINITY);
                if number.abs() > half { unit.copysign(number) } else { 0.0f64.copysign(number) }
            }
            count if count < 0 => 0.0f64.copysign(number),
            count => format!("{number:.*e}", count as usize - 1).parse().unwrap_or(number),
        }
    };
    if rounded.is_infinite() { Err(Fault::new("the rounded value is too large for a float")) } else { Ok(rounded) }
}
