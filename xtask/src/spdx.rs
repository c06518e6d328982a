//! SPDX licence expressions: `(MIT OR Apache-2.0) AND Unicode-3.0`, and the old `MIT/Apache-2.0`.
//!
//! `AND` binds tighter than `OR`. An exception (`WITH …`) only adds permissions, so its licence alone decides.

/// Whether the licences in `allowed` are enough to use a work under this expression.
pub fn satisfiable(expression: &str, allowed: &[&str]) -> Result<bool, String> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " / ");
    let mut words = spaced.split_whitespace().peekable();
    let verdict = either(&mut words, allowed)?;
    match words.next() {
        None => Ok(verdict),
        Some(word) => Err(format!("`{word}` was not expected")),
    }
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

fn either(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    let mut verdict = both(words, allowed)?;
    while words.next_if(|word| ["OR", "or", "/"].contains(word)).is_some() {
        verdict |= both(words, allowed)?;
    }
    Ok(verdict)
}

fn both(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    let mut verdict = one(words, allowed)?;
    while words.next_if(|word| ["AND", "and"].contains(word)).is_some() {
        verdict &= one(words, allowed)?;
    }
    Ok(verdict)
}

fn one(words: &mut Words, allowed: &[&str]) -> Result<bool, String> {
    let verdict = match words.next() {
        Some("(") => {
            let verdict = either(words, allowed)?;
            words.next_if_eq(&")").ok_or("a parenthesis is not closed")?;
            return Ok(verdict);
        }
        Some(word) if is_identifier(word) => allowed.contains(&word),
        Some(word) => return Err(format!("`{word}` where a licence was expected")),
        None => return Err("it ends where a licence was expected".into()),
    };
    if words.next_if(|word| ["WITH", "with"].contains(word)).is_some() {
        words.next_if(|word| is_identifier(word)).ok_or("WITH names no exception")?;
    }
    Ok(verdict)
}

fn is_identifier(word: &str) -> bool {
    let operator = ["AND", "OR", "WITH"].contains(&word.to_ascii_uppercase().as_str());
    !operator && word.chars().all(|c| c.is_ascii_alphanumeric() || "-.+:".contains(c))
}

#[cfg(test)]
mod tests {
    use super::satisfiable;

    fn allowed(expression: &str) -> Result<bool, String> {
        satisfiable(expression, &["MIT", "Apache-2.0", "Unicode-3.0"])
    }

    #[test]
    fn one_licence() {
        assert_eq!(allowed("MIT"), Ok(true));
        assert_eq!(allowed("GPL-3.0-only"), Ok(false));
        assert_eq!(allowed("MIT-0"), Ok(false));
        assert_eq!(allowed("Apache-2.0+"), Ok(false));
    }

    #[test]
    fn or_needs_one_and_needs_both() {
        assert_eq!(allowed("MIT OR GPL-3.0-only"), Ok(true));
        assert_eq!(allowed("GPL-3.0-only OR LGPL-3.0-only"), Ok(false));
        assert_eq!(allowed("MIT AND Unicode-3.0"), Ok(true));
        assert_eq!(allowed("MIT AND GPL-3.0-only"), Ok(false));
        assert_eq!(allowed("Zlib OR Apache-2.0 OR MIT"), Ok(true));
    }

    #[test]
    fn a_slash_is_an_old_or() {
        assert_eq!(allowed("MIT/GPL-2.0"), Ok(true));
        assert_eq!(allowed("Unlicense / MIT"), Ok(true));
        assert_eq!(allowed("GPL-2.0/LGPL-2.1"), Ok(false));
    }

    #[test]
    fn and_binds_tighter_than_or() {
        assert_eq!(allowed("MIT OR GPL-2.0 AND GPL-3.0"), Ok(true));
        assert_eq!(allowed("GPL-2.0 AND GPL-3.0 OR MIT"), Ok(true));
        assert_eq!(allowed("(MIT OR GPL-2.0) AND GPL-3.0"), Ok(false));
        assert_eq!(allowed("(MIT OR Apache-2.0) AND Unicode-3.0"), Ok(true));
        assert_eq!(allowed("GPL-2.0 OR (MIT AND (GPL-2.0 OR Apache-2.0))"), Ok(true));
    }

    #[test]
    fn an_exception_only_adds() {
        assert_eq!(allowed("Apache-2.0 WITH LLVM-exception"), Ok(true));
        assert_eq!(allowed("Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT"), Ok(true));
        assert_eq!(allowed("GPL-2.0 WITH Classpath-exception-2.0"), Ok(false));
    }

    #[test]
    fn what_is_no_expression_is_an_error() {
        for wrong in ["", "MIT OR", "OR MIT", "(MIT", "MIT)", "MIT Apache-2.0", "MIT WITH", "()", "MIT, Zlib"] {
            assert!(allowed(wrong).is_err(), "{wrong:?}");
        }
    }
}
