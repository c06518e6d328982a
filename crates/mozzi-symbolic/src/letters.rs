//! Names in plain letters, and digits below the line.

use crate::atom::Name;

const SUBSCRIPTS: [char; 10] = ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'];

/// A name in letters, digits and underscores: `theta1`, `dtheta1`, `I1_xx`.
pub(crate) fn plain_name(name: &Name) -> String {
    let letter = match name.letter {
        "θ" => "theta",
        "τ" => "tau",
        "φ" => "phi",
        "μ" => "mu",
        other => other,
    };
    let dots = "d".repeat(name.dots.into());
    let number = name.number.map_or(String::new(), |n| n.to_string());
    let clean = |c: char| match c {
        'ω' => 'w',
        '\'' => 'q',
        c if c.is_ascii_alphanumeric() => c,
        _ => '_',
    };
    let part: String = name.part.chars().map(clean).collect();
    let part = if part.is_empty() { part } else { format!("_{part}") };
    format!("{dots}{letter}{number}{part}")
}

/// Digits below the line.
pub(crate) fn below(n: usize) -> String {
    n.to_string().bytes().map(|digit| SUBSCRIPTS[usize::from(digit - b'0')]).collect()
}
