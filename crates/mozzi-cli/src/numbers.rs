//! Numbers from the command line.

use crate::angles;
use crate::failure::{Failure, Result};
use crate::terminal::excerpt;
use std::fmt::Display;

/// A finite number; `place` is its source in messages: "--step", "table.csv:3: column 2 (`tau_1`)".
pub fn number(place: impl Display, text: &str) -> Result<f64> {
    let (x, unit) = with_unit(&place, text)?;
    match unit {
        Unit::Plain => Ok(x),
        Unit::Degrees | Unit::Radians => {
            Err(Failure::wrong(format!("{place} is `{}`, which is no angle", excerpt(text.trim()))))
        }
    }
}

/// An angle in radians: `1.5`, in degrees with `--deg`; `pi/2`; `45deg`.
pub fn angle(place: impl Display, text: &str) -> Result<f64> {
    with_unit(place, text).map(|(x, unit)| in_radians(x, unit))
}

fn in_radians(x: f64, unit: Unit) -> f64 {
    if unit == Unit::Plain && angles::are_degrees() { x.to_radians() } else { x }
}

/// Angles, separated by commas, of which only those that `are_angles` may be in degrees.
pub fn angles(place: &str, text: &str, are_angles: &[bool]) -> Result<Vec<f64>> {
    let entry = |(k, text): (usize, &str)| {
        let place = format_args!("{place}: entry {}", k + 1);
        if are_angles.get(k) == Some(&false) { number(place, text) } else { angle(place, text) }
    };
    entries(text).enumerate().map(entry).collect()
}

/// The number of entries of a list.
pub fn count(text: &str) -> usize {
    entries(text).count()
}

/// One number for all, or one for each, of which those that `are_angles` may be in degrees.
pub fn one_or_each(flag: &str, text: &str, are_angles: &[bool]) -> Result<Vec<f64>> {
    let (count, n) = (entries(text).count(), are_angles.len());
    if count == 1 {
        let one = |&is_angle: &bool| if is_angle { angle(flag, text) } else { number(flag, text) };
        return are_angles.iter().map(one).collect();
    }
    match count == n {
        true => angles(flag, text, are_angles),
        false => Err(wrong_count(flag, count, n, "one for each velocity, or one for all")),
    }
}

/// The suffix of a number.
#[derive(Clone, Copy, PartialEq)]
enum Unit {
    Plain,
    /// A multiple of π.
    Radians,
    Degrees,
}

fn with_unit(place: impl Display, text: &str) -> Result<(f64, Unit)> {
    let text = text.trim();
    let wrong = |expected| Err(Failure::wrong(format!("{place} is `{}`, expected {expected}", excerpt(text))));
    match value(&text.replace('−', "-")) {
        Some((x, unit)) if x.is_finite() => Ok((x, unit)),
        Some(_) => wrong("a finite number"),
        None if has_unit(text) => wrong("a number without its unit"),
        None => wrong("a number"),
    }
}

/// "2s", "5 kg": a number and letters.
fn has_unit(text: &str) -> bool {
    let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c)).trim_start();
    let number = text[..text.len() - unit.len()].trim_end();
    let is_hexadecimal = number == "0" && unit.starts_with(['x', 'X']);
    number.parse::<f64>().is_ok() && unit.starts_with(char::is_alphabetic) && !is_hexadecimal
}

/// True for a number or an angle as [`angle`] reads it.
pub fn is_number(text: &str) -> bool {
    value(&text.trim().replace('−', "-")).is_some()
}

/// "1.5", "pi/2", "-3pi/4", "2*pi", "1.5rad", and in degrees "45deg" or "45°".
fn value(text: &str) -> Option<(f64, Unit)> {
    if let Ok(x) = text.parse() {
        return Some((x, Unit::Plain));
    }
    if let Some(degrees) = text.strip_suffix("deg").or(text.strip_suffix('°')) {
        return degrees.trim().parse::<f64>().ok().map(|x| (x.to_radians(), Unit::Degrees));
    }
    if let Some(radians) = text.strip_suffix("rad") {
        return radians.trim().parse::<f64>().ok().map(|x| (x, Unit::Radians));
    }
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    let factor = over.trim().strip_suffix("pi").or(over.trim().strip_suffix('π'))?;
    let factor = match factor.trim_end().trim_end_matches('*').trim_end() {
        "" | "+" => 1.0,
        "-" => -1.0,
        factor => factor.parse::<f64>().ok()?,
    };
    let under: f64 = under.trim().parse().ok().filter(|x| *x != 0.0)?;
    Some((factor * std::f64::consts::PI / under, Unit::Radians))
}

/// Finite numbers, separated by commas or spaces.
pub fn numbers(place: &str, text: &str) -> Result<Vec<f64>> {
    entries(text).enumerate().map(|(k, entry)| number(format_args!("{place}: entry {}", k + 1), entry)).collect()
}

/// The entries of a list: "1,2", "1 2", "[1, 2]" as Python prints it, "(1, 2)".
fn entries(text: &str) -> impl Iterator<Item = &str> {
    let text = text.trim();
    let within = |open, close| text.strip_prefix(open).and_then(|text| text.strip_suffix(close));
    let text = within('[', ']').or_else(|| within('(', ')')).unwrap_or(text).trim();
    let has_commas = text.contains(',');
    let is_end = move |c: char| if has_commas { c == ',' } else { c.is_whitespace() };
    text.split(is_end).filter(move |entry| !text.is_empty() && (has_commas || !entry.is_empty()))
}

/// One number for each name.
pub fn numbers_for<'n>(place: &str, text: &str, names: impl ExactSizeIterator<Item = &'n str>) -> Result<Vec<f64>> {
    let found = numbers(place, text)?;
    if found.len() == names.len() {
        return Ok(found);
    }
    Err(wrong_number(place, found.len(), &names.collect::<Vec<_>>()))
}

/// "--theta has 3 entries, expected 2: shoulder, elbow"
pub fn wrong_number(place: &str, count: usize, names: &[&str]) -> Failure {
    let mut list: Vec<&str> = names.iter().copied().take(12).collect();
    if names.len() > list.len() {
        list.push("…");
    }
    wrong_count(place, count, names.len(), &list.join(", "))
}

/// "--theta has 3 entries, expected 6: …"
pub fn wrong_count(place: &str, count: usize, expected: usize, what: &str) -> Failure {
    let entries = if count == 1 { "entry" } else { "entries" };
    Failure::wrong(format!("{place} has {count} {entries}, expected {expected}: {what}"))
}

/// As [`numbers_for`], of a known length.
pub fn array<const K: usize>(place: &str, text: &str, names: [&str; K]) -> Result<[f64; K]> {
    let found = numbers_for(place, text, names.iter().copied())?;
    <[f64; K]>::try_from(found).map_err(|_| Failure::wrong(format!("{place}: expected {K} entries")))
}

/// The entries of a wrench, angular first.
pub const WRENCH: [&str; 6] = ["m_x", "m_y", "m_z", "f_x", "f_y", "f_z"];
/// The entries of a twist, angular first.
pub const TWIST: [&str; 6] = ["ω_x", "ω_y", "ω_z", "v_x", "v_y", "v_z"];

#[cfg(test)]
mod tests {
    use super::{angle, angles, number, numbers};
    use std::f64::consts::PI;

    #[test]
    fn angles_are_written_as_people_write_them() {
        let read = |text: &str| angle("--theta", text).ok();
        for (text, expected) in [
            ("1.5", 1.5),
            ("pi", PI),
            ("-pi/2", -PI / 2.0),
            ("3pi/4", 3.0 * PI / 4.0),
            ("2*pi", 2.0 * PI),
            ("−π", -PI),
            ("45deg", PI / 4.0),
            ("-90°", -PI / 2.0),
            ("0.5rad", 0.5),
        ] {
            assert!((read(text).expect(text) - expected).abs() < 1e-15, "{text}");
        }
        for text in ["pie", "pi/0", "1/2", "deg", "inf", "2pi3", "--pi"] {
            assert!(read(text).is_none(), "{text}");
        }
        for text in ["0.5,-1", "0.5 -1", "[0.5, -1]", "(0.5, -1)", " [0.5  -1] "] {
            assert_eq!(numbers("--theta", text).ok(), Some(vec![0.5, -1.0]), "{text}");
        }
        assert_eq!(numbers("--theta", " ").ok(), Some(Vec::new()));
        for text in ["1,,2", "[1,2", "1;2", "1, 2 3"] {
            assert!(numbers("--theta", text).is_err(), "{text}");
        }
        for text in ["45deg", "2rad", "pi/2"] {
            assert!(number("--step", text).is_err(), "{text}");
        }
        assert!(angles("--theta", "45deg,45deg", &[true, false]).is_err());
    }
}
