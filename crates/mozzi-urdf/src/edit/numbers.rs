//! Numbers in texts of xacro and YAML, with their places.

use roxmltree::{Document, Node};
use std::ops::Range;

/// A number that stands alone: no letter, digit, `_` or `.` next to it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub span: Range<usize>,
    pub value: f64,
}

/// The numbers of a part of a text.
pub(super) fn numbers_in(text: &str, part: Range<usize>) -> Vec<Number> {
    let (bytes, mut at, mut found) = (text.as_bytes(), part.start, Vec::new());
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.');
    let digits = |mut k: usize| {
        while k < part.end && bytes[k].is_ascii_digit() {
            k += 1;
        }
        k
    };
    while at < part.end {
        let sign = matches!(bytes[at], b'-' | b'+');
        let start = at + usize::from(sign);
        let whole = digits(start);
        let fraction = if bytes.get(whole) == Some(&b'.') { digits(whole + 1) } else { whole };
        if fraction - start <= usize::from(fraction > whole) {
            at += 1; // no digit
            continue;
        }
        let mut end = fraction;
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let signed = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'-' | b'+')));
            let exponent = digits(signed);
            end = if exponent > signed { exponent } else { end };
        }
        // `2-1` subtracts, `2 -1` may be two numbers
        let before = text[part.start..at].bytes().next_back();
        let joined = start > part.start && is_word(bytes[start - 1]);
        let subtracts = sign && before.is_some_and(|byte| is_word(byte) || matches!(byte, b')' | b']'));
        let first = if subtracts { start } else { at };
        let follows = bytes.get(end).is_some_and(|byte| end < part.end && is_word(*byte));
        if let (false, false, Ok(value)) = (joined, follows, text[first..end].parse::<f64>()) {
            found.push(Number { span: first..end, value });
        }
        at = end.max(at + 1);
        // the rest of a word is no number
        while at < part.end && is_word(bytes[at]) && is_word(bytes[at - 1]) {
            at += 1;
        }
    }
    found
}

/// Numbers from which others may follow: in attributes of xacro's elements, and in expressions.
pub(super) fn of_xacro(text: &str) -> Vec<Number> {
    let Ok(document) = Document::parse(text) else { return Vec::new() };
    let is_xacro = |node: &Node| text[node.range().start + 1..].starts_with("xacro:");
    let mut found = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        for attribute in node.attributes() {
            if is_xacro(&node) || attribute.value().contains("${") || attribute.value().contains("$(") {
                found.extend(numbers_in(text, attribute.range_value()));
            }
        }
    }
    found
}

/// The numbers of a YAML text, without comments.
pub(super) fn of_yaml(text: &str) -> Vec<Number> {
    let (mut found, mut start) = (Vec::new(), 0);
    for line in text.split_inclusive('\n') {
        let length = if line.trim_start().starts_with('#') { 0 } else { line.find(" #").unwrap_or(line.len()) };
        found.extend(numbers_in(text, start..start + length));
        start += line.len();
    }
    found
}

/// The words of a part of a text.
pub(super) fn words(text: &str, part: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let start = part.start;
    let inside = &text[part];
    inside.split_ascii_whitespace().map(move |word| {
        let at = start + (word.as_ptr() as usize - inside.as_ptr() as usize);
        at..at + word.len()
    })
}

/// The words of all attributes.
pub(super) fn all_words(document: &Document<'_>) -> Vec<Range<usize>> {
    let text = document.input_text();
    let attributes = document.descendants().filter(Node::is_element).flat_map(|node| node.attributes());
    attributes.flat_map(|attribute| words(text, attribute.range_value()).collect::<Vec<_>>()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_alone() {
        let values = |text: &str| numbers_in(text, 0..text.len()).iter().map(|n| n.value).collect::<Vec<_>>();
        assert_eq!(values("0 -1.5 2e-3 .5 3."), [0.0, -1.5, 2e-3, 0.5, 3.0]);
        assert_eq!(values("${a1 - 2} ${b-3} (-4) link5 6kg x_7 v1.0.1"), [2.0, 3.0, -4.0]);
        assert_eq!(values("mass:=1.25 a='2'"), [1.25, 2.0]);
        let yaml = "a: 1.5 # 2.5\n# 3.5\nb: [4, -5e1]\n";
        assert_eq!(of_yaml(yaml).iter().map(|n| n.value).collect::<Vec<_>>(), [1.5, 4.0, -50.0]);
        assert_eq!(&yaml[of_yaml(yaml)[2].span.clone()], "-5e1");
    }
}
