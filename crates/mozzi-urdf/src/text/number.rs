//! Numbers and vectors of numbers: the whole text or nothing.

use std::fmt;
use std::ops::Range;

/// Why a text is not a number or a vector.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NotNumbers {
    /// One of its words.
    Word { span: Range<usize>, word: String, why: NotANumber },
    /// The number of words.
    Count { found: usize, expected: usize },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotANumber {
    Empty,
    NotFinite,
    TooLarge,
    Comma,
    /// MJCF only: a URDF with xacro expressions is refused before its numbers are read.
    Macro,
    Unit,
    Nonsense,
}

impl NotANumber {
    pub fn code(self) -> &'static str {
        match self {
            NotANumber::NotFinite => "not_finite",
            NotANumber::TooLarge => "too_large_number",
            NotANumber::Comma => "decimal_comma",
            NotANumber::Macro => "xacro",
            _ => "not_a_number",
        }
    }

    pub fn help(self) -> Option<&'static str> {
        match self {
            NotANumber::Unit => Some("write the number without a unit: metres, radians, kilograms, seconds"),
            _ => None,
        }
    }
}

impl fmt::Display for NotANumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NotANumber::NotFinite => "a finite number",
            NotANumber::TooLarge => "a number below 1.8e308",
            _ => "a number",
        })
    }
}

/// Units that users write after a number.
const UNITS: [&str; 14] = ["kg", "g", "m", "cm", "mm", "rad", "deg", "°", "n", "nm", "n*m", "rad/s", "m/s", "kg*m^2"];

/// A number: digits with an optional sign, point and exponent, nothing else.
pub(crate) fn number(word: &str) -> Result<f64, NotANumber> {
    let plain = word.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E'));
    if let (true, Ok(x)) = (plain, word.parse::<f64>()) {
        return if x.is_finite() { Ok(x) } else { Err(NotANumber::TooLarge) };
    }
    let bare = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    Err(if word.is_empty() {
        NotANumber::Empty
    } else if ["nan", "inf", "infinity", "1.#inf", "1.#qnan", "1.#ind"].contains(&bare.as_str()) {
        NotANumber::NotFinite
    } else if word.contains("${") || word.contains("$(") {
        NotANumber::Macro
    } else if word.contains(',') && word.bytes().all(|b| b.is_ascii_digit() || b"+-.,eE".contains(&b)) {
        NotANumber::Comma
    } else if bare.starts_with(|c: char| c.is_ascii_digit()) && bare.ends_with(|c: char| c.is_alphabetic() || c == '°')
        || UNITS.contains(&bare.as_str())
    {
        NotANumber::Unit
    } else {
        NotANumber::Nonsense
    })
}

/// Exactly N numbers, separated by white space.
pub(crate) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], NotNumbers> {
    let (values, found) = up_to::<N>(text)?;
    match found {
        0 if N == 1 => Err(NotNumbers::Word { span: 0..text.len(), word: String::new(), why: NotANumber::Empty }),
        _ if found == N => Ok(values),
        _ => Err(NotNumbers::Count { found, expected: N }),
    }
}

/// The first N numbers of a text, padded with zeros, and the number of numbers in the text.
pub(crate) fn up_to<const N: usize>(text: &str) -> Result<([f64; N], usize), NotNumbers> {
    let (mut values, mut found) = ([0.0; N], 0);
    for value in each(text) {
        let value = value?;
        if let Some(slot) = values.get_mut(found) {
            *slot = value;
        }
        found += 1;
    }
    Ok((values, found))
}

/// All numbers of a text, separated by white space.
pub(crate) fn all_numbers(text: &str) -> Result<Vec<f64>, NotNumbers> {
    each(text).collect()
}

/// The words of a text as numbers.
fn each(text: &str) -> impl Iterator<Item = Result<f64, NotNumbers>> {
    let is_space = |c: char| matches!(c, ' ' | '\t' | '\r' | '\n');
    let start = move |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
    text.split(is_space).filter(|word| !word.is_empty()).map(move |word| {
        number(word).map_err(|why| {
            let shown = if word.chars().count() > 40 {
                format!("{}…", word.chars().take(40).collect::<String>())
            } else {
                word.to_string()
            };
            NotNumbers::Word { span: start(word)..start(word) + word.len(), word: shown, why }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_whole() {
        for (text, x) in [("1", 1.0), ("+1.", 1.0), ("-.5", -0.5), ("1e-3", 1e-3), ("  2\n", 2.0), ("1E5", 1e5)] {
            assert_eq!(numbers::<1>(text), Ok([x]), "{text}");
        }
        for (text, why) in [
            ("nan", NotANumber::NotFinite),
            ("-INF", NotANumber::NotFinite),
            ("1e999", NotANumber::TooLarge),
            ("0,5", NotANumber::Comma),
            ("${pi/2}", NotANumber::Macro),
            ("1.0abc", NotANumber::Unit),
            ("90°", NotANumber::Unit),
            ("kg", NotANumber::Unit),
            ("0x10", NotANumber::Nonsense),
            ("1-2", NotANumber::Nonsense),
            ("--1", NotANumber::Nonsense),
            ("e", NotANumber::Nonsense),
            ("one", NotANumber::Nonsense),
            ("", NotANumber::Empty),
        ] {
            assert_eq!(number(text), Err(why), "{text}");
        }
        assert_eq!(numbers::<3>("1 2"), Err(NotNumbers::Count { found: 2, expected: 3 }));
        assert_eq!(numbers::<3>("1 2 3 4"), Err(NotNumbers::Count { found: 4, expected: 3 }));
        assert_eq!(numbers::<3>(""), Err(NotNumbers::Count { found: 0, expected: 3 }));
        let Err(NotNumbers::Word { span, .. }) = numbers::<3>("1 zwo 3") else { panic!("a word that is no number") };
        assert_eq!(span, 2..5);
    }
}
