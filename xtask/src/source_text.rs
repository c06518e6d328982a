//! Rust source prepared for the rules: comments, strings and tests are blanked; line numbers stay the same.

/// Blank comments, strings and character literals; newlines stay.
pub fn code_only(source: &str) -> String {
    blank(source, true)
}

/// Blank strings and character literals; comments, other code and newlines stay.
pub fn without_literals(source: &str) -> String {
    blank(source, false)
}

fn blank(source: &str, comments: bool) -> String {
    let mut code = String::with_capacity(source.len());
    let mut rest = source;
    let mut in_word = false; // the r of `for"…"` starts no raw string
    while let Some(c) = rest.chars().next() {
        let token = match c {
            _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            _ if rest.starts_with("/*") => block_comment(rest),
            '"' => string(rest),
            'r' if !in_word => raw_string(rest),
            '\'' => character(rest),
            _ => 0,
        };
        let length = if token == 0 { c.len_utf8() } else { token };
        let (taken, after) = rest.split_at(length);
        match token {
            0 => code.push(c),
            _ if taken.starts_with('/') && !comments => code.push_str(taken),
            _ => code.extend(taken.chars().map(|c| if c == '\n' { '\n' } else { ' ' })),
        }
        in_word = token == 0 && (c.is_alphanumeric() || c == '_') && c != 'b' && c != 'c';
        rest = after;
    }
    code
}

/// Length of a block comment, including nested ones.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let step = &text.as_bytes()[at..];
        let (change, length) = match step {
            [b'/', b'*', ..] => (1, 2),
            [b'*', b'/', ..] => (-1, 2),
            _ => (0, 1),
        };
        depth += change;
        at += length;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// Length of a string from its quote on.
fn string(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return at + 1,
            _ => escaped = c == '\\' && !escaped,
        }
    }
    text.len()
}

/// Length of `r"…"` or `r#"…"#`; 0 if it is not a raw string.
fn raw_string(text: &str) -> usize {
    let hashes = text[1..].bytes().take_while(|&b| b == b'#').count();
    if text.as_bytes().get(1 + hashes) != Some(&b'"') {
        return 0;
    }
    let (open, close) = (2 + hashes, format!("\"{}", "#".repeat(hashes)));
    text[open..].find(&close).map_or(text.len(), |at| open + at + close.len())
}

/// Length of a character literal; 0 for a lifetime.
fn character(text: &str) -> usize {
    let mut inner = text.char_indices().skip(1);
    match (inner.next(), inner.next()) {
        (Some((_, '\\')), Some((after, _))) => {
            let from = after + text[after..].chars().next().map_or(0, char::len_utf8);
            text[from..].find('\'').map_or(0, |at| from + at + 1)
        }
        (Some(_), Some((at, '\''))) => at + 1,
        _ => 0,
    }
}

/// Blank every item under `#[cfg(test)]` in a text of `code_only`.
pub fn without_tests(code: &str) -> String {
    const MARK: &str = "#[cfg(test)]";
    let mut kept = String::with_capacity(code.len());
    let mut rest = code;
    while let Some(at) = rest.find(MARK) {
        kept.push_str(&rest[..at]);
        let item = &rest[at..];
        let end = item_end(item, MARK.len());
        kept.extend(item[..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        rest = &item[end..];
    }
    kept + rest
}

/// The end of an item: its closing brace, or a semicolon outside every bracket.
fn item_end(text: &str, from: usize) -> usize {
    let mut depth = 0;
    for (at, c) in text.char_indices().skip_while(|&(at, _)| at < from) {
        match c {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 && (c == ';' || c == '}') {
            return at + 1;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::{code_only, without_tests};

    #[test]
    fn comments_and_literals_are_blanked() {
        let source =
            "a(); // .unwrap()\n/* x /* y */ todo!() */ b(\"un\\\"safe\", r#\"to\"do\"#, '\"', b'\\'');\nfn f<'a>() {}";
        let code = code_only(source);
        assert_eq!(code.lines().count(), 3);
        assert!(code.contains("a();") && code.contains("b(") && code.contains("fn f<'a>() {}"));
        assert!(["unwrap", "todo", "safe", "do"].iter().all(|word| !code.contains(word)), "{code}");
    }

    #[test]
    fn text_beyond_ascii_is_no_trouble() {
        assert_eq!(code_only("let θ = 'θ'; /* τ */ θ̇").replace(' ', ""), "letθ=;θ̇");
        assert_eq!(code_only("'\\u{3b8}' x").trim(), "x");
    }

    #[test]
    fn tests_are_blanked_and_lines_stay() {
        let code = "a;\n#[cfg(test)]\nmod tests {\n  fn f() { x.unwrap() }\n}\nb;\n#[cfg(test)]\nmod more;\nc;";
        let kept = without_tests(code);
        assert_eq!(kept.lines().count(), code.lines().count());
        assert_eq!(kept.split_whitespace().collect::<Vec<_>>(), ["a;", "b;", "c;"]);
    }

    #[test]
    fn a_signature_with_an_array_is_one_item() {
        let kept = without_tests("#[cfg(test)]\nfn f(x: [u8; 2]) { y }\nz");
        assert_eq!(kept.trim(), "z");
    }
}
