//! The value of a plain scalar of YAML 1.1.

use crate::expression::{Value, parse_float, parse_int};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;

pub(crate) fn plain(text: &str) -> Result<Value> {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Ok(Value::None),
        "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => return Ok(Value::Bool(true)),
        "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => return Ok(Value::Bool(false)),
        ".nan" | ".NaN" | ".NAN" => return Ok(Value::Float(f64::NAN)),
        "=" | "<<" => return Err(Fault::new(format!("`{text}` is not supported as a value"))),
        _ => {}
    }
    let (is_negative, unsigned) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    if [".inf", ".Inf", ".INF"].contains(&unsigned) {
        return Ok(Value::Float(if is_negative { f64::NEG_INFINITY } else { f64::INFINITY }));
    }
    if !unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Ok(Value::text(text));
    }
    if let Some(size) = whole(unsigned)? {
        return Ok(Value::Int(if is_negative { -size } else { size }));
    }
    // a number that begins with the decimal point has no sign
    let may_be_real = unsigned.len() == text.len() || !unsigned.starts_with('.');
    if let Some(size) = Some(unsigned).filter(|_| may_be_real).and_then(real) {
        return Ok(Value::Float(if is_negative { -size } else { size }));
    }
    if is_date(text) {
        return Err(Fault::new(format!("`{text}` is a date, which is not supported; quotes make it text")));
    }
    Ok(Value::text(text))
}

fn whole(text: &str) -> Result<Option<BigInt>> {
    let row = |digits: &str, radix: u32| !digits.is_empty() && digits.chars().all(|c| c == '_' || c.is_digit(radix));
    let number = |digits: &str, radix: u32| {
        let plain = digits.replace('_', "");
        let found = parse_int(&plain, radix);
        found.ok_or_else(|| Fault::new(format!("`{text}` is not a number of a size that is supported"))).map(Some)
    };
    if let Some(digits) = text.strip_prefix("0b").filter(|digits| row(digits, 2)) {
        return number(digits, 2);
    }
    if let Some(digits) = text.strip_prefix("0x").filter(|digits| row(digits, 16)) {
        return number(digits, 16);
    }
    if let Some(digits) = text.strip_prefix('0').filter(|digits| row(digits, 8)) {
        // "0_" is 0
        return if digits.bytes().all(|b| b == b'_') { Ok(Some(BigInt::from(0))) } else { number(digits, 8) };
    }
    if text == "0" {
        return Ok(Some(BigInt::from(0)));
    }
    if text.starts_with(|c: char| ('1'..='9').contains(&c)) {
        let mut parts = text.split(':');
        let first = parts.next().unwrap_or_default();
        let rest: Vec<&str> = parts.collect();
        if row(first, 10) && rest.iter().all(|part| is_sixty(part)) {
            let mut total = number(first, 10)?.unwrap_or_default();
            for part in rest {
                total = total * 60 + part.parse::<u32>().unwrap_or_default();
            }
            return Ok(Some(total));
        }
    }
    Ok(None)
}

/// `0` to `59`, as the later parts of a number to base 60.
fn is_sixty(part: &str) -> bool {
    match part.as_bytes() {
        [digit] => digit.is_ascii_digit(),
        [tens, digit] => (b'0'..=b'5').contains(tens) && digit.is_ascii_digit(),
        _ => false,
    }
}

fn real(text: &str) -> Option<f64> {
    let digits = |part: &str| part.chars().all(|c| c == '_' || c.is_ascii_digit());
    let (before, after) = text.split_once('.')?;
    if before.contains(':') {
        let mut parts = before.split(':');
        let first = parts.next()?;
        let rest: Vec<&str> = parts.collect();
        if !first.starts_with(|c: char| c.is_ascii_digit())
            || !digits(first)
            || !digits(after)
            || !rest.iter().all(|part| is_sixty(part))
        {
            return None;
        }
        let mut total: f64 = first.replace('_', "").parse().ok()?;
        let last = rest.len().checked_sub(1)?;
        for (k, part) in rest.iter().enumerate() {
            let part = if k == last { format!("{part}.{}", after.replace('_', "")) } else { part.to_string() };
            total = total * 60.0 + part.trim_end_matches('.').parse::<f64>().ok()?;
        }
        return Some(total);
    }
    let (mantissa, exponent) = match after.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (after, None),
    };
    let has_exponent = |exponent: &str| {
        exponent
            .strip_prefix(['+', '-'])
            .is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()))
    };
    let begins = |part: &str| part.starts_with(|c: char| c.is_ascii_digit());
    let is_real = digits(before) && digits(mantissa) && exponent.is_none_or(has_exponent);
    let is_begun = if before.is_empty() { begins(mantissa) } else { begins(before) };
    if !is_real || !is_begun {
        return None;
    }
    parse_float(&text.replace('_', ""))
}

fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.splitn(3, '-').collect();
    let digits =
        |part: &str, most: usize| !part.is_empty() && part.len() <= most && part.bytes().all(|b| b.is_ascii_digit());
    match parts.as_slice() {
        [year, month, rest] if year.len() == 4 && digits(year, 4) && digits(month, 2) => {
            let day = rest.bytes().take_while(u8::is_ascii_digit).count();
            match rest.len() {
                length if length == day => month.len() == 2 && day == 2,
                _ => {
                    (1..=2).contains(&day)
                        && rest[day..].contains(':')
                        && rest[day..].starts_with(['T', 't', ' ', '\t'])
                }
            }
        }
        _ => false,
    }
}
