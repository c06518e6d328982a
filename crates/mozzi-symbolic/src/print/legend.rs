//! The legend: the meaning of each symbol in the robot's file.

use super::Style;
use crate::parameters::Meaning;
use crate::rational::Rational;

/// A line for each symbol, and for angles that were read as multiples of π.
pub(crate) fn legend(symbols: &[Meaning], of_pi: &[(String, Rational)], style: &impl Style) -> Vec<String> {
    let mut lines = Vec::new();
    if !symbols.is_empty() {
        lines.extend([String::new(), "in the file:".to_string()]);
    }
    for meaning in symbols {
        lines.push(format!(
            "  {} = {} {}: {}",
            style.name(&meaning.name),
            meaning.value,
            meaning.unit,
            meaning.places.join("; ")
        ));
    }
    if let Some(note) = angles(of_pi) {
        lines.extend([String::new(), note]);
    }
    lines
}

/// A line about angles that were read as multiples of π, if there are any.
pub(crate) fn angles(of_pi: &[(String, Rational)]) -> Option<String> {
    let mut angles: Vec<(String, String)> = Vec::new();
    for (written, multiple) in of_pi {
        let text = written.rsplit(' ').next().unwrap_or(written);
        let known = (text.to_string(), multiple_of_pi(multiple));
        if !angles.contains(&known) {
            angles.push(known);
        }
    }
    let all: Vec<String> = angles.iter().map(|(text, multiple)| format!("{text} as {multiple}")).collect();
    (!all.is_empty()).then(|| format!("angles of the file read as multiples of π: {}", all.join(", ")))
}

/// π/2, −3π/4.
fn multiple_of_pi(multiple: &Rational) -> String {
    let (a, b) = multiple.parts();
    let sign = if multiple.is_negative() { "−" } else { "" };
    let a = a.magnitude().to_string();
    let a = if a == "1" { String::new() } else { a };
    let over = if b == 1.into() { String::new() } else { format!("/{b}") };
    format!("{sign}{a}π{over}")
}
