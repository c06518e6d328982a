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

/// A file's name as a part of a line: without line breaks and other characters that are not printed, which would end a
/// comment or turn the text's direction.
pub(crate) fn printable(name: &str) -> String {
    let is_unseen = |c: char| {
        c.is_control()
            || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
    };
    name.chars().map(|c| if is_unseen(c) { '_' } else { c }).collect()
}

/// Digits below the line.
pub(crate) fn below(n: usize) -> String {
    n.to_string().bytes().map(|digit| SUBSCRIPTS[usize::from(digit - b'0')]).collect()
}
