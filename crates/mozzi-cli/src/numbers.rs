//! Numbers from the command line.

use crate::failure::{Failure, Result};
use crate::terminal::excerpt;
use std::fmt::Display;

/// A finite number; `place` is its source in messages: "--step", "table.csv:3: column 2 (`tau_1`)".
pub fn number(place: impl Display, text: &str) -> Result<f64> {
    let text = text.trim();
    let wrong = |expected| Err(Failure::wrong(format!("{place} is `{}`, expected {expected}", excerpt(text))));
    match value(&text.replace('−', "-")) {
        Some(x) if x.is_finite() => Ok(x),
        Some(_) => wrong("a finite number"),
        None => wrong("a number"),
    }
}

/// "1.5", "pi/2", "-3pi/4", "2*pi", and in degrees "45deg" or "45°".
fn value(text: &str) -> Option<f64> {
    if let Ok(x) = text.parse() {
        return Some(x);
    }
    if let Some(degrees) = text.strip_suffix("deg").or(text.strip_suffix('°')) {
        return degrees.trim().parse::<f64>().ok().map(f64::to_radians);
    }
    let (over, under) = text.split_once('/').unwrap_or((text, "1"));
    let factor = over.trim().strip_suffix("pi").or(over.trim().strip_suffix('π'))?;
    let factor = match factor.trim_end().trim_end_matches('*').trim_end() {
        "" | "+" => 1.0,
        "-" => -1.0,
        factor => factor.parse::<f64>().ok()?,
    };
    let under: f64 = under.trim().parse().ok().filter(|x| *x != 0.0)?;
    Some(factor * std::f64::consts::PI / under)
}

/// Finite numbers, separated by commas.
pub fn numbers(place: &str, text: &str) -> Result<Vec<f64>> {
    if text.trim().is_empty() {
        return Ok(Vec::new());
    }
    text.split(',').enumerate().map(|(k, entry)| number(format_args!("{place}: entry {}", k + 1), entry)).collect()
}

/// One number for each name.
pub fn numbers_for<'n>(
    place: &str,
    text: &str,
    names: impl ExactSizeIterator<Item = &'n str> + Clone,
) -> Result<Vec<f64>> {
    let found = numbers(place, text)?;
    if found.len() == names.len() {
        return Ok(found);
    }
    let mut list: Vec<&str> = names.clone().take(12).collect();
    if names.len() > list.len() {
        list.push("…");
    }
    Err(wrong_count(place, found.len(), names.len(), &list.join(", ")))
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
    use super::number;
    use std::f64::consts::PI;

    #[test]
    fn angles_are_written_as_people_write_them() {
        let read = |text: &str| number("--theta", text).ok();
        for (text, expected) in [
            ("1.5", 1.5),
            ("pi", PI),
            ("-pi/2", -PI / 2.0),
            ("3pi/4", 3.0 * PI / 4.0),
            ("2*pi", 2.0 * PI),
            ("−π", -PI),
            ("45deg", PI / 4.0),
            ("-90°", -PI / 2.0),
        ] {
            assert!((read(text).expect(text) - expected).abs() < 1e-15, "{text}");
        }
        for text in ["pie", "pi/0", "1/2", "deg", "inf", "2pi3", "--pi"] {
            assert!(read(text).is_none(), "{text}");
        }
    }
}
