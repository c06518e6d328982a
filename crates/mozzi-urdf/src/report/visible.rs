//! Text that a terminal shows without interpreting it.

/// Escapes control characters (C0 except line feed and tab, DEL, C1) and marks that change the direction of writing, as
/// `\u001b`. JSON and Python read this form, too.
///
/// ```
/// assert_eq!(mozzi_urdf::visible("a\u{1b}[31m\u{9b}\tb\n"), "a\\u001b[31m\\u009b\tb\n");
/// ```
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_invisible(c) {
            shown.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            shown.push(c);
        }
    }
    shown
}

fn is_invisible(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    (c.is_control() && !matches!(c, '\n' | '\t')) || turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_control_character_is_left() {
        let all: String = ('\0'..='\u{2fff}').collect();
        let left: String = visible(&all).chars().filter(|c| c.is_control()).collect();
        assert_eq!(left, "\t\n");
        assert_eq!(visible("äθ̇ 日本 \r\u{7f}\u{85}\u{202e}"), "äθ̇ 日本 \\u000d\\u007f\\u0085\\u202e");
        assert_eq!(visible(&visible("\u{1b}")), visible("\u{1b}"));
    }
}
