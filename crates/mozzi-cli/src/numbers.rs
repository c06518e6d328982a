//! Numbers from the command line.

use crate::failure::{Failure, Result};
use crate::terminal::excerpt;
use std::fmt::Display;

/// A finite number; `place` is its source in messages: "--step", "table.csv:3: column 2 (`tau_1`)".
pub fn number(place: impl Display, text: &str) -> Result<f64> {
    let text = text.trim();
    let wrong = |expected| Err(Failure::wrong(format!("{place} is `{}`, expected {expected}", excerpt(text))));
    match text.replace('−', "-").parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => wrong("a finite number"),
        Err(_) => wrong("a number"),
    }
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
