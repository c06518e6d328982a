//! Tokens of an expression.

use crate::expression::syntax::Literal;
use crate::expression::syntax::literal;
use crate::expression::syntax::names::{KEYWORDS, begins_name, continues_name};
use crate::fault::{Fault, Result};

#[derive(Clone)]
pub(crate) enum Token {
    Constant(Literal),
    Name(String),
    /// A keyword of Python's.
    Keyword(&'static str),
    Operator(&'static str),
    End,
}

/// Longer ones first.
const OPERATORS: [&str; 41] = [
    "**=", "//=", ">>=", "<<=", "...", "**", "//", ">>", "<<", "<=", ">=", "==", "!=", ":=", "->", "+=", "-=", "*=",
    "/=", "%=", "&=", "|=", "^=", "@=", "+", "-", "*", "/", "%", "@", "&", "|", "^", "~", "<", ">", ".", ",", ":", "=",
    ";",
];
const BRACKETS: [&str; 6] = ["(", ")", "[", "]", "{", "}"];

/// All tokens of a text, each with the byte where it begins.
pub(crate) fn tokens(text: &str) -> Result<Vec<(usize, Token)>> {
    let mut found: Vec<(usize, Token)> = Vec::new();
    let mut open: Vec<(&str, usize)> = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let (start, rest) = (at, &text[at..]);
        let operator = || OPERATORS.iter().find(|operator| rest.starts_with(**operator));
        if matches!(c, ' ' | '\t' | '\x0c') {
            at += 1;
        } else if matches!(c, '\n' | '\r') {
            if open.is_empty() && !rest.trim().is_empty() {
                return Err(Fault::at(start, "the line ends inside the expression, expected parentheses around it"));
            }
            at += 1;
        } else if c == '#' {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("\\\n") {
            at += 2;
        } else if c.is_ascii_digit() || c == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit()) {
            let (value, length) = literal::number(rest).map_err(|fault| fault.further(start))?;
            found.push((start, Token::Constant(value)));
            at += length;
        } else if let Some((value, length)) = literal::string(rest).map_err(|fault| fault.further(start))? {
            found.push((start, Token::Constant(value)));
            at += length;
        } else if begins_name(c) {
            let length = rest.find(|c: char| !continues_name(c)).unwrap_or(rest.len());
            let name = &rest[..length];
            let keyword = KEYWORDS.iter().find(|keyword| **keyword == name);
            found.push((start, keyword.map_or_else(|| Token::Name(name.to_string()), |k| Token::Keyword(k))));
            at += length;
        } else if let Some(bracket) = BRACKETS.iter().find(|bracket| rest.starts_with(**bracket)) {
            match *bracket {
                "(" | "[" | "{" => open.push((bracket, start)),
                close => {
                    let pair = open.pop().map(|(opening, _)| opening);
                    if !matches!((pair, close), (Some("("), ")") | (Some("["), "]") | (Some("{"), "}")) {
                        return Err(Fault::at(start, format!("`{close}` closes nothing here")));
                    }
                }
            }
            found.push((start, Token::Operator(bracket)));
            at += 1;
        } else if let Some(operator) = operator() {
            found.push((start, Token::Operator(operator)));
            at += operator.len();
        } else {
            return Err(Fault::at(start, format!("`{}` does not belong to an expression", c.escape_debug())));
        }
    }
    if let Some((bracket, start)) = open.pop() {
        return Err(Fault::at(start, format!("`{bracket}` is never closed")));
    }
    found.push((text.len(), Token::End));
    Ok(found)
}
