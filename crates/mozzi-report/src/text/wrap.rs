//! Lines that are not wider than the page.

use crate::text::width;

/// A line in parts of at most `most` columns, broken at spaces; further parts are indented by `hang` more columns. A
/// word that is wider stays whole.
pub fn wrapped(line: &str, most: usize, hang: usize) -> Vec<String> {
    if width(line) <= most {
        return vec![line.to_string()];
    }
    let indent = line.len() - line.trim_start_matches(' ').len();
    let mut parts = Vec::new();
    let mut part = " ".repeat(indent);
    let mut is_empty = true;
    for word in line[indent..].split(' ') {
        if !is_empty && width(&part) + 1 + width(word) > most {
            parts.push(part.trim_end().to_string());
            part = " ".repeat(indent + hang);
            is_empty = true;
        }
        if !is_empty {
            part.push(' ');
        }
        // the spaces of a column's gap do not begin a line
        if !(is_empty && word.is_empty() && !parts.is_empty()) {
            part.push_str(word);
            is_empty = false;
        }
    }
    if !part.trim().is_empty() {
        parts.push(part.trim_end().to_string());
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn lines_break_at_spaces_and_keep_their_indentation() {
        assert_eq!(wrapped("  one two three", 20, 2), ["  one two three"]);
        assert_eq!(wrapped("  one two three four", 13, 2), ["  one two", "    three", "    four"]);
        assert_eq!(wrapped("unbreakable,line", 5, 2), ["unbreakable,line"]);
        assert_eq!(wrapped("θ̇θ̇θ̇ θ̇", 5, 2), ["θ̇θ̇θ̇ θ̇"]);
    }
}
