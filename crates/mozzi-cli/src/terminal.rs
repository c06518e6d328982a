//! Text for a terminal: no control characters, no endless lines.

use mozzi_urdf::visible;

/// Longer lines are cut.
const LONGEST: usize = 4000;
/// Digits that identify a float64 uniquely.
const DIGITS: usize = 17;

/// A message: control characters are escaped, long lines cut, and numbers have at most 17 digits.
pub fn message(text: &str) -> String {
    let lines = text.split_inclusive('\n').map(|line| cut(&visible(line)));
    lines.map(|line| short_numbers(&line)).collect()
}

/// A result: escaped like a message, but not shortened.
pub fn result(text: &str) -> String {
    visible(text)
}

/// At most forty characters, on one line.
pub fn excerpt(text: &str) -> String {
    let count = text.chars().count();
    let begin: String = text.chars().take(40).collect();
    if count > 40 { format!("{begin}… ({count} characters)") } else { begin }
}

fn cut(line: &str) -> String {
    let count = line.chars().count();
    if count <= LONGEST {
        return line.to_string();
    }
    let half = |skipped: usize| line.chars().skip(skipped).take(LONGEST / 2).collect::<String>();
    format!("{}… ({} characters) …{}", half(0), count - LONGEST, half(count - LONGEST / 2))
}

/// Writes 1e300 in place of its three hundred digits; text other than a float64 as Rust writes it is unchanged.
fn short_numbers(line: &str) -> String {
    let is_part = |c: char| c.is_alphanumeric() || ".-_/`".contains(c);
    let mut text = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(begin) = rest.find(is_part) {
        let end = rest[begin..].find(|c| !is_part(c)).map_or(rest.len(), |end| begin + end);
        text.push_str(&rest[..begin]);
        let word = &rest[begin..end];
        text.push_str(&short(word).unwrap_or_else(|| word.to_string()));
        rest = &rest[end..];
    }
    text + rest
}

fn short(word: &str) -> Option<String> {
    let word_end = word.trim_end_matches('.');
    let digits = word_end.trim_start_matches(['-', '0', '.']).chars().filter(char::is_ascii_digit).count();
    if digits <= DIGITS && word_end.len() <= 2 * DIGITS {
        return None;
    }
    let x: f64 = word_end.parse().ok()?;
    (x.to_string() == word_end).then(|| format!("{x:e}{}", &word[word_end.len()..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_at_most_seventeen_digits() {
        for x in [1e300, -2.5e-300, 1e18, f64::MAX, f64::MIN_POSITIVE, 123456789012345680000.0] {
            let found = message(&format!("t is {x}, expected less than {x}.\n"));
            assert_eq!(found, format!("t is {x:e}, expected less than {x:e}.\n"));
        }
        for kept in
            ["0.1234567890123456", "18446744073709551615", "run/20250101000000000000.csv", "`1000000000000000000`"]
        {
            assert_eq!(message(kept), kept);
        }
    }

    #[test]
    fn lines_end() {
        let found = message(&format!("a {}\nb\n", "x".repeat(50_000_000)));
        assert!(
            found.len() < 5000 && found.contains("… (49996003 characters) …") && found.ends_with("\nb\n"),
            "{found}"
        );
        assert_eq!(excerpt(&"ä".repeat(41)), format!("{}… (41 characters)", "ä".repeat(40)));
        assert_eq!(message("\u{1b}]52;c;aGFja2Vk\u{7}\u{9b}2J\r\n"), "\\u001b]52;c;aGFja2Vk\\u0007\\u009b2J\\u000d\n");
    }
}
