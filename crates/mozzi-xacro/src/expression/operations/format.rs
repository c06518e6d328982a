//! `format(value, specification)`: Python's format specification with width, sign and precision.

use crate::bounds::{Budget, MOST_TEXT};
use crate::expression::values::float;
use crate::expression::values::integer;
use crate::expression::values::kinds::a_kind;
use crate::expression::values::repr;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_bigint::{BigInt, Sign};

/// `[[fill]align][sign][z][#][0][width][,][.precision][type]`
#[derive(Clone, Default)]
pub(crate) struct Specification {
    pub fill: Option<char>,
    pub align: Option<char>,
    pub sign: Option<char>,
    pub is_alternate: bool,
    pub width: usize,
    pub grouping: Option<char>,
    pub precision: Option<usize>,
    pub kind: Option<char>,
}

impl Specification {
    pub fn parse(text: &str) -> Result<Specification> {
        let mut spec = Specification::default();
        let letters: Vec<char> = text.chars().collect();
        let mut at = 0;
        let is_align = |c: Option<&char>| matches!(c, Some('<' | '>' | '=' | '^'));
        if is_align(letters.get(1)) {
            (spec.fill, spec.align, at) = (Some(letters[0]), Some(letters[1]), 2);
        } else if is_align(letters.first()) {
            (spec.align, at) = (Some(letters[0]), 1);
        }
        let takes = |at: &mut usize, wanted: &[char]| {
            let found = letters.get(*at).copied().filter(|c| wanted.contains(c));
            *at += usize::from(found.is_some());
            found
        };
        spec.sign = takes(&mut at, &['+', '-', ' ']);
        if takes(&mut at, &['z']).is_some() {
            return Err(Fault::new("the flag `z` of a format is not supported"));
        }
        spec.is_alternate = takes(&mut at, &['#']).is_some();
        if takes(&mut at, &['0']).is_some() {
            spec.fill = spec.fill.or(Some('0'));
            spec.align = spec.align.or(Some('0')); // like '=', but not for strings
        }
        let number = |at: &mut usize| -> Result<Option<usize>> {
            let start = *at;
            while letters.get(*at).is_some_and(char::is_ascii_digit) {
                *at += 1;
            }
            let digits: String = letters[start..*at].iter().collect();
            match digits.parse::<usize>() {
                Ok(number) if number <= MOST_TEXT => Ok(Some(number)),
                Ok(_) => Err(Fault::new(format!("a width or precision of {digits}, expected at most {MOST_TEXT}"))),
                Err(_) if digits.is_empty() => Ok(None),
                Err(_) => Err(Fault::new("a width or precision that is too large")),
            }
        };
        spec.width = number(&mut at)?.unwrap_or(0);
        spec.grouping = takes(&mut at, &[',', '_']);
        if takes(&mut at, &['.']).is_some() {
            let precision = number(&mut at)?;
            spec.precision = Some(precision.ok_or_else(|| Fault::new("a format has `.` without a precision"))?);
        }
        spec.kind = letters.get(at).copied();
        at += usize::from(spec.kind.is_some());
        if at < letters.len() {
            return Err(Fault::new(format!("`{text}` is not a format")));
        }
        Ok(spec)
    }

    /// A number's sign, prefix and digits, padded to the width.
    pub fn padded(&self, sign: &str, prefix: &str, digits: &str, default: char) -> String {
        let digits = match self.grouping {
            None => digits.to_string(),
            Some(mark) => {
                let size = if matches!(self.kind, Some('x' | 'X' | 'o' | 'b')) { 4 } else { 3 };
                let zeros = matches!((self.align, self.fill), (Some('0' | '='), Some('0')));
                let least = if zeros { self.width.saturating_sub(sign.len() + prefix.len()) } else { 0 };
                grouped(digits, mark, size, least)
            }
        };
        let missing = self.width.saturating_sub(sign.len() + prefix.len() + digits.chars().count());
        let fill = |count: usize| self.fill.unwrap_or(' ').to_string().repeat(count);
        match self.align.unwrap_or(default) {
            '<' => format!("{sign}{prefix}{digits}{}", fill(missing)),
            '^' => format!("{}{sign}{prefix}{digits}{}", fill(missing / 2), fill(missing - missing / 2)),
            '=' | '0' => format!("{sign}{prefix}{}{digits}", fill(missing)),
            _ => format!("{}{sign}{prefix}{digits}", fill(missing)),
        }
    }

    fn sign_of(&self, is_negative: bool) -> &'static str {
        match self.sign {
            _ if is_negative => "-",
            Some('+') => "+",
            Some(' ') => " ",
            _ => "",
        }
    }
}

/// Inserts separators between groups of digits of the integer part, and zeros before it up to a length.
fn grouped(digits: &str, mark: char, size: usize, least: usize) -> String {
    let end =
        digits.find(|c: char| !c.is_ascii_hexdigit() || matches!(c, 'e' | 'E') && size == 3).unwrap_or(digits.len());
    let (whole, rest) = digits.split_at(end);
    let mut letters: Vec<char> = Vec::new();
    let total = |letters: usize| letters + rest.len();
    let mut source = whole.chars().rev();
    let mut count = 0;
    loop {
        let next = source.next();
        if next.is_none() && total(letters.len()) >= least {
            break;
        }
        if count > 0 && count % size == 0 {
            letters.push(mark);
        }
        letters.push(next.unwrap_or('0'));
        count += 1;
    }
    letters.into_iter().rev().collect::<String>() + rest
}

/// `format(value, specification)`.
pub(crate) fn format(budget: &Budget, value: &Value, specification: &str) -> Result<String> {
    if specification.is_empty() {
        return repr_text(budget, value);
    }
    let spec = Specification::parse(specification)?;
    budget.text(spec.width + spec.precision.unwrap_or(0))?;
    let wrong = || Err(Fault::new(format!("`{specification}` is not a format of {}", a_kind(value))));
    match value {
        Value::Str(text) => {
            if !matches!(spec.kind, None | Some('s'))
                || spec.sign.is_some()
                || spec.is_alternate
                || spec.align == Some('=')
                || spec.grouping.is_some()
            {
                return wrong();
            }
            let cut: String = text.chars().take(spec.precision.unwrap_or(usize::MAX)).collect();
            let align = spec.align.filter(|align| *align != '0');
            Ok(Specification { align, grouping: None, ..spec }.padded("", "", &cut, '<'))
        }
        Value::Bool(value) if spec.kind.is_none() => {
            whole(&spec, &BigInt::from(i32::from(*value))).map_or_else(wrong, Ok)
        }
        Value::Int(_) | Value::Bool(_) => {
            let number = value.as_int().unwrap_or_default();
            match spec.kind {
                Some('e' | 'E' | 'f' | 'F' | 'g' | 'G' | '%') => {
                    real(&spec, integer::to_float(&number)?).map_or_else(wrong, Ok)
                }
                _ => whole(&spec, &number).map_or_else(wrong, Ok),
            }
        }
        Value::Float(number) => real(&spec, *number).map_or_else(wrong, Ok),
        _ => wrong(),
    }
}

fn repr_text(budget: &Budget, value: &Value) -> Result<String> {
    repr::text_of(budget, value)
}

fn whole(spec: &Specification, number: &BigInt) -> Option<String> {
    if spec.precision.is_some() {
        return None;
    }
    let (is_negative, size) = (number.sign() == Sign::Minus, number.magnitude());
    let (prefix, digits) = match spec.kind {
        None | Some('d' | 'n') if spec.kind != Some('n') || spec.grouping.is_none() => ("", size.to_string()),
        Some('x') if spec.grouping != Some(',') => ("0x", size.to_str_radix(16)),
        Some('X') if spec.grouping != Some(',') => ("0X", size.to_str_radix(16).to_uppercase()),
        Some('o') if spec.grouping != Some(',') => ("0o", size.to_str_radix(8)),
        Some('b') if spec.grouping != Some(',') => ("0b", size.to_str_radix(2)),
        Some('c') if spec.sign.is_none() && spec.grouping.is_none() && !spec.is_alternate => {
            let c = u32::try_from(number).ok().and_then(char::from_u32)?;
            return Some(spec.padded("", "", &c.to_string(), '<'));
        }
        _ => return None,
    };
    Some(spec.padded(spec.sign_of(is_negative), if spec.is_alternate { prefix } else { "" }, &digits, '>'))
}

fn real(spec: &Specification, number: f64) -> Option<String> {
    let is_negative = number.is_sign_negative() && !number.is_nan();
    let size = number.abs();
    let digits = match spec.kind {
        None => match spec.precision {
            None => float::repr(size),
            Some(precision) => general(size, precision.max(1), spec.is_alternate, true),
        },
        Some('n') if spec.grouping.is_some() => return None,
        Some(kind @ ('e' | 'E' | 'f' | 'F' | 'g' | 'G' | 'n')) => {
            real_digits(kind, size, spec.precision, spec.is_alternate)
        }
        Some('%') => real_digits('f', size * 100.0, spec.precision, spec.is_alternate) + "%",
        _ => return None,
    };
    Some(spec.padded(spec.sign_of(is_negative), "", &digits, '>'))
}

/// The digits of a number that is not negative, as C's `printf` writes them.
pub(crate) fn real_digits(kind: char, size: f64, precision: Option<usize>, is_alternate: bool) -> String {
    let precision = precision.unwrap_or(6);
    let text = if !size.is_finite() {
        float::repr(size)
    } else {
        match kind.to_ascii_lowercase() {
            'e' => exponential(size, precision, is_alternate),
            'f' => fixed(size, precision) + if is_alternate && precision == 0 { "." } else { "" },
            _ => general(size, precision.max(1), is_alternate, false),
        }
    };
    if kind.is_ascii_uppercase() { text.to_uppercase() } else { text }
}

/// More decimals than any float has: further ones are zeros. Rust's own formatting takes at most 65535.
const MOST_DECIMALS: usize = 1100;

fn zeros_after(precision: usize) -> String {
    "0".repeat(precision.saturating_sub(MOST_DECIMALS))
}

fn fixed(size: f64, decimals: usize) -> String {
    format!("{size:.*}", decimals.min(MOST_DECIMALS)) + &zeros_after(decimals)
}

fn exponential(size: f64, precision: usize, is_alternate: bool) -> String {
    let text = format!("{size:.*e}", precision.min(MOST_DECIMALS));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let mantissa = mantissa.to_string() + &zeros_after(precision);
    let point = if is_alternate && precision == 0 { "." } else { "" };
    format!("{mantissa}{point}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}

/// This many digits, without trailing zeros; in exponential form if that is shorter. `is_repr`: at least one decimal,
/// as for a float without a presentation type.
fn general(size: f64, precision: usize, is_alternate: bool, is_repr: bool) -> String {
    if !size.is_finite() {
        return float::repr(size);
    }
    let text = format!("{size:.*e}", (precision - 1).min(MOST_DECIMALS));
    let exponent: i64 = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or_default();
    let most = if is_repr { precision as i64 - 1 } else { precision as i64 };
    let trim = |text: &str| match text.contains('.') && !is_alternate {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    if exponent < -4 || exponent >= most {
        let text = exponential(size, precision - 1, is_alternate);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "+00"));
        return format!("{}e{exponent}", trim(mantissa));
    }
    let decimals = (precision as i64 - 1 - exponent).max(0) as usize;
    let text = trim(&fixed(size, decimals));
    if is_repr && !text.contains('.') { text + ".0" } else { text }
}
