//! `template % values`.

use crate::bounds::MOST_TEXT;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::format::{Specification, real_digits};
use crate::expression::values::float;
use crate::expression::values::kinds;
use crate::expression::values::kinds::{a_kind, as_float};
use crate::expression::values::repr;
use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use num_bigint::Sign;

/// The values that are not written yet.
struct Values<'v> {
    all: &'v Value,
    next: usize,
}

impl Values<'_> {
    fn next(&mut self) -> Result<Value> {
        self.next += 1;
        let value = match self.all {
            Value::Tuple(items) => items.get(self.next - 1).cloned(),
            other => (self.next == 1).then(|| other.clone()),
        };
        value.ok_or_else(|| Fault::new("`%` has fewer values than the text has places"))
    }
}

pub(crate) fn format(cx: &Evaluator, template: &str, all: &Value) -> Result<Value> {
    let budget = cx.host.budget();
    budget.text(template.len())?;
    let (mut values, mut out, mut rest, mut is_named) = (Values { all, next: 0 }, String::new(), template, false);
    while let Some(at) = rest.find('%') {
        out.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        let mut value = None;
        if let Some(named) = rest.strip_prefix('(') {
            let end = named.find(')').ok_or_else(|| Fault::new("`%(` is never closed"))?;
            let Value::Dict(entries, _) = all else {
                return Err(Fault::new(format!("`%({})` takes a dict, found {}", &named[..end], a_kind(all))));
            };
            let found = entries.borrow().text_key(&named[..end]).cloned();
            value = Some(found.ok_or_else(|| Fault::new(format!("the dict has no key `{}`", &named[..end])))?);
            (rest, is_named) = (&named[end + 1..], true);
        }
        let (spec, after) = specification(rest, &mut values)?;
        rest = after;
        if spec.kind == Some('%') {
            out.push('%');
            continue;
        }
        budget.text(spec.width + spec.precision.unwrap_or(0))?;
        let value = value.map_or_else(|| values.next(), Ok)?;
        out.push_str(&written(cx, &spec, &value)?);
        if out.len() > MOST_TEXT {
            budget.text(out.len())?;
        }
    }
    out.push_str(rest);
    let all_used = match all {
        Value::Tuple(items) => values.next == items.len(),
        // a value with items may stay unused
        Value::Dict(..) | Value::List(..) | Value::Range(_) => true,
        _ => values.next == 1 || is_named,
    };
    if !all_used {
        return Err(Fault::new("`%` has more values than the text has places"));
    }
    budget.text(out.len())?;
    Ok(Value::text(out))
}

/// Flags, width, precision and kind, and what follows them.
fn specification<'t>(text: &'t str, values: &mut Values) -> Result<(Specification, &'t str)> {
    let mut spec = Specification::default();
    let mut rest = text;
    let (mut is_left, mut has_zeros) = (false, false);
    while let Some(flag) = rest.chars().next().filter(|c| "-+ #0".contains(*c)) {
        match flag {
            '-' => is_left = true,
            '+' => spec.sign = Some('+'),
            ' ' => spec.sign = spec.sign.or(Some(' ')),
            '#' => spec.is_alternate = true,
            _ => has_zeros = true,
        }
        rest = &rest[1..];
    }
    let mut number = |rest: &mut &'t str| -> Result<Option<i64>> {
        if let Some(after) = rest.strip_prefix('*') {
            *rest = after;
            return kinds::whole(&values.next()?, "`*`").map(Some);
        }
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let digits = &rest[..end];
        *rest = &rest[end..];
        if digits.is_empty() {
            return Ok(None);
        }
        digits
            .parse()
            .ok()
            .filter(|n| *n <= MOST_TEXT as i64)
            .map(Some)
            .ok_or_else(|| Fault::new(format!("a width or precision of {digits}, expected at most {MOST_TEXT}")))
    };
    let width = number(&mut rest)?.unwrap_or(0);
    is_left |= width < 0;
    spec.width = width.unsigned_abs() as usize;
    if let Some(after) = rest.strip_prefix('.') {
        rest = after;
        spec.precision = Some(number(&mut rest)?.unwrap_or(0).max(0) as usize);
    }
    rest = rest.trim_start_matches(['h', 'l', 'L']);
    let kind =
        rest.chars().next().ok_or_else(|| Fault::new("`%` ends the text, expected a kind such as `%d` or `%.3f`"))?;
    spec.kind = Some(kind);
    spec.align = Some(match (is_left, has_zeros && "diuoxXeEfFgG".contains(kind)) {
        (true, _) => '<',
        (false, true) => '=',
        (false, false) => '>',
    });
    spec.fill = (spec.align == Some('=')).then_some('0');
    Ok((spec, &rest[kind.len_utf8()..]))
}

fn written(cx: &Evaluator, spec: &Specification, value: &Value) -> Result<String> {
    let kind = spec.kind.unwrap_or('s');
    let sign = |is_negative: bool| match spec.sign {
        _ if is_negative => "-",
        Some('+') => "+",
        Some(_) => " ",
        None => "",
    };
    let wrong = || Fault::new(format!("`%{kind}` takes a number, found {}", a_kind(value)));
    match kind {
        's' | 'r' | 'a' => {
            let text = if kind == 's' {
                crate::expression::values::repr::text_of(cx.host.budget(), value)?
            } else {
                repr::repr(cx.host.budget(), value)?
            };
            let cut: String = text.chars().take(spec.precision.unwrap_or(usize::MAX)).collect();
            Ok(spec.padded("", "", &cut, '>'))
        }
        'c' => match (value, value.as_int()) {
            (Value::Str(text), _) if text.chars().count() == 1 => Ok(spec.padded("", "", text, '>')),
            (_, Some(code)) => {
                let c = u32::try_from(code).ok().and_then(char::from_u32).ok_or_else(wrong)?;
                Ok(spec.padded("", "", &c.to_string(), '>'))
            }
            _ => Err(Fault::new(format!("`%c` takes one character, found {}", a_kind(value)))),
        },
        'd' | 'i' | 'u' | 'x' | 'X' | 'o' => {
            let number = match (value, value.as_int()) {
                (_, Some(number)) => number,
                (Value::Float(number), _) if matches!(kind, 'd' | 'i' | 'u') => float::whole(number.trunc())?,
                _ => return Err(wrong()),
            };
            let size = number.magnitude();
            let (prefix, digits) = match kind {
                'x' => ("0x", size.to_str_radix(16)),
                'X' => ("0X", size.to_str_radix(16).to_uppercase()),
                'o' => ("0o", size.to_str_radix(8)),
                _ => ("", size.to_string()),
            };
            let zeros = spec.precision.unwrap_or(0).saturating_sub(digits.len());
            let prefix = if spec.is_alternate { prefix } else { "" };
            Ok(spec.padded(sign(number.sign() == Sign::Minus), prefix, &("0".repeat(zeros) + &digits), '>'))
        }
        'e' | 'E' | 'f' | 'F' | 'g' | 'G' => {
            let number = if value.is_number() { as_float(value)? } else { return Err(wrong()) };
            let digits = real_digits(kind, number.abs(), spec.precision, spec.is_alternate);
            Ok(spec.padded(sign(number.is_sign_negative() && !number.is_nan()), "", &digits, '>'))
        }
        other => Err(Fault::new(format!("`%{other}` is not a format"))),
    }
}
