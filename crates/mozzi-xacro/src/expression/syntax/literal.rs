//! Numbers and strings in an expression.

use crate::bounds::MOST_DIGITS;
use crate::expression::syntax::Literal;
use crate::expression::syntax::names::{KEYWORDS, begins_name, continues_name};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;

/// A number at the beginning of a text, and its length.
pub(crate) fn number(text: &str) -> Result<(Literal, usize)> {
    let based = text.get(1..2).filter(|_| text.starts_with('0')).and_then(|letter| match letter {
        "x" | "X" => Some((16, "hexadecimal")),
        "o" | "O" => Some((8, "octal")),
        "b" | "B" => Some((2, "binary")),
        _ => None,
    });
    let (value, length) = match based {
        Some((radix, name)) => {
            let length = 2 + digits(&text[2..], radix, true);
            let written = text[2..length].replace('_', "");
            if written.is_empty() {
                return Err(Fault::at(0, format!("`{}` is an invalid {name} number", &text[..length])));
            }
            if written.len() > MOST_DIGITS {
                return Err(Fault::at(
                    0,
                    format!("a number of {} digits, expected at most {MOST_DIGITS}", written.len()),
                ));
            }
            (Literal::Int(BigInt::parse_bytes(written.as_bytes(), radix).unwrap_or_default()), length)
        }
        None => decimal(text)?,
    };
    let rest = &text[length..];
    if rest.starts_with(['j', 'J']) {
        return Err(Fault::at(length, "complex numbers are not supported"));
    }
    let word = &rest[..rest.find(|c: char| !continues_name(c)).unwrap_or(rest.len())];
    if rest.starts_with(continues_name) && !KEYWORDS.contains(&word) {
        return Err(Fault::at(0, format!("`{}{word}` is an invalid number", &text[..length])));
    }
    Ok((value, length))
}

fn decimal(text: &str) -> Result<(Literal, usize)> {
    let whole = digits(text, 10, false);
    let mut length = whole;
    let mut is_float = false;
    if text[length..].starts_with('.') {
        is_float = true;
        length += 1;
        length += digits(&text[length..], 10, false);
    }
    let exponent = &text[length..];
    if exponent.starts_with(['e', 'E']) {
        let sign = 1 + usize::from(exponent[1..].starts_with(['+', '-']));
        let count = digits(&exponent[sign..], 10, false);
        if count > 0 {
            is_float = true;
            length += sign + count;
        }
    }
    let written = text[..length].replace('_', "");
    if is_float {
        return Ok((Literal::Float(written.parse().unwrap_or(f64::NAN)), length));
    }
    if written.len() > 1 && written.starts_with('0') && written.bytes().any(|b| b != b'0') {
        return Err(Fault::at(
            0,
            format!("`{written}` has a leading zero, expected `{}`", written.trim_start_matches('0')),
        ));
    }
    if written.len() > MOST_DIGITS {
        return Err(Fault::at(0, format!("a number of {} digits, expected at most {MOST_DIGITS}", written.len())));
    }
    Ok((Literal::Int(BigInt::parse_bytes(written.as_bytes(), 10).unwrap_or_default()), length))
}

/// The length of a row of digits, with single underscores between them.
fn digits(text: &str, radix: u32, may_begin_with_underscore: bool) -> usize {
    let (mut length, mut last_is_digit) = (0, may_begin_with_underscore);
    for c in text.chars() {
        match c {
            '_' if last_is_digit => last_is_digit = false,
            c if c.is_digit(radix) => last_is_digit = true,
            _ => break,
        }
        length += 1;
    }
    if !last_is_digit && length > 0 { length - 1 } else { length }
}

/// A string at the beginning of a text, and its length; None if no string begins here.
pub(crate) fn string(text: &str) -> Result<Option<(Literal, usize)>> {
    let prefix = text.find(|c: char| !begins_name(c)).filter(|length| *length <= 2).unwrap_or(0);
    let letters = text[..prefix].to_ascii_lowercase();
    if !["", "r", "u", "b", "f", "br", "rb", "fr", "rf"].contains(&&*letters) {
        return Ok(None);
    }
    let rest = &text[prefix..];
    let Some(quote) = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| rest.starts_with(quote)) else {
        return Ok(None);
    };
    if letters.contains('b') {
        return Err(Fault::at(0, "bytes are not supported, expected a string"));
    }
    if letters.contains('f') {
        return Err(Fault::at(0, "f-strings are not supported"));
    }
    let (is_raw, body) = (letters.contains('r'), &rest[quote.len()..]);
    let (mut value, mut at) = (String::new(), 0);
    loop {
        let Some(c) = body[at..].chars().next() else {
            return Err(Fault::at(prefix, "the string is never closed"));
        };
        if body[at..].starts_with(quote) {
            return Ok(Some((Literal::Str(value.into()), prefix + 2 * quote.len() + at)));
        }
        if c == '\n' && quote.len() == 1 {
            return Err(Fault::at(prefix, "the line ends inside the string"));
        }
        at += c.len_utf8();
        if c != '\\' {
            value.push(c);
            continue;
        }
        let next = body[at..].chars().next();
        if is_raw {
            value.push('\\');
            value.extend(next);
            at += next.map_or(0, char::len_utf8);
        } else {
            let (text, length) = escape(&body[at..]).map_err(|fault| fault.further(prefix + quote.len() + at - 1))?;
            value.push_str(&text);
            at += length;
        }
    }
}

/// The meaning of a backslash and the text after it, and the length of that text.
fn escape(text: &str) -> Result<(String, usize)> {
    let Some(letter) = text.chars().next() else { return Ok((String::new(), 0)) };
    let one = |c: &str| Ok((c.to_string(), 1));
    let hexadecimal = |length: usize| {
        let written = text.get(1..1 + length).filter(|digits| digits.bytes().all(|b| b.is_ascii_hexdigit()));
        let code = written.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        match code.and_then(char::from_u32) {
            Some(c) => Ok((c.to_string(), 1 + length)),
            None => Err(Fault::at(0, format!("`\\{letter}` expects {length} hexadecimal digits of a character"))),
        }
    };
    match letter {
        '\n' => one(""),
        '\\' => one("\\"),
        '\'' => one("'"),
        '"' => one("\""),
        'a' => one("\x07"),
        'b' => one("\x08"),
        'f' => one("\x0c"),
        'n' => one("\n"),
        'r' => one("\r"),
        't' => one("\t"),
        'v' => one("\x0b"),
        'x' => hexadecimal(2),
        'u' => hexadecimal(4),
        'U' => hexadecimal(8),
        'N' => Err(Fault::at(0, "`\\N` is not supported, expected `\\u`")),
        '0'..='7' => {
            let length = text.bytes().take(3).take_while(|b| (b'0'..=b'7').contains(b)).count();
            let code = u32::from_str_radix(&text[..length], 8).ok().and_then(char::from_u32).unwrap_or_default();
            Ok((code.to_string(), length))
        }
        other => Ok((format!("\\{other}"), other.len_utf8())),
    }
}
