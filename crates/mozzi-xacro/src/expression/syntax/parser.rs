//! Parses tokens into a syntax tree: operators by precedence, loosest first.

use crate::bounds::MOST_EXPRESSION_DEPTH;
use crate::expression::syntax::token::{Token, tokens};
use crate::expression::syntax::{Binary, Compare, Kind, LambdaSyntax, Literal, Node, Unary};
use crate::fault::{Fault, Result};
use std::rc::Rc;

pub(crate) struct Parser<'t> {
    text: &'t str,
    tokens: Vec<(usize, Token)>,
    next: usize,
    depth: usize,
}

/// The tree of an expression.
pub(crate) fn parse(text: &str) -> Result<Node> {
    let mut parser = Parser { text, tokens: tokens(text)?, next: 0, depth: 0 };
    if matches!(parser.peek(), Token::End) {
        return Err(Fault::at(0, "the expression is empty"));
    }
    let at = parser.at();
    let first = parser.expression()?;
    let tree = if parser.is(",") { parser.rest_of_tuple(at, first, false)? } else { first };
    match parser.peek() {
        Token::End => Ok(tree),
        _ => Err(parser.unexpected("the end of the expression")),
    }
}

/// Loosest first; all are left-associative.
const LEVELS: [&[(&str, Binary)]; 6] = [
    &[("|", Binary::BitOr)],
    &[("^", Binary::BitXor)],
    &[("&", Binary::BitAnd)],
    &[("<<", Binary::ShiftLeft), (">>", Binary::ShiftRight)],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[("*", Binary::Multiply), ("/", Binary::Divide), ("//", Binary::FloorDivide), ("%", Binary::Modulo)],
];

impl Parser<'_> {
    pub fn peek(&self) -> &Token {
        &self.tokens[self.next].1
    }

    pub fn at(&self) -> usize {
        self.tokens[self.next].0
    }

    pub fn advance(&mut self) -> Token {
        let token = self.peek().clone();
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        token
    }

    pub fn is(&self, operator: &str) -> bool {
        matches!(self.peek(), Token::Operator(found) if *found == operator)
    }

    pub fn is_keyword(&self, word: &str) -> bool {
        matches!(self.peek(), Token::Keyword(found) if *found == word)
    }

    /// Reads an operator, if it is the next word.
    pub fn takes(&mut self, operator: &str) -> bool {
        let is_next = self.is(operator);
        if is_next {
            self.advance();
        }
        is_next
    }

    pub fn takes_keyword(&mut self, word: &str) -> bool {
        let is_next = self.is_keyword(word);
        if is_next {
            self.advance();
        }
        is_next
    }

    pub fn expect(&mut self, operator: &str) -> Result<()> {
        if self.takes(operator) { Ok(()) } else { Err(self.unexpected(&format!("`{operator}`"))) }
    }

    pub fn name(&mut self) -> Result<Rc<str>> {
        match self.peek().clone() {
            Token::Name(name) => {
                self.advance();
                Ok(name.into())
            }
            _ => Err(self.unexpected("a name")),
        }
    }

    /// An error for an unexpected token.
    pub fn unexpected(&self, expected: &str) -> Box<Fault> {
        let found = match self.peek() {
            Token::End => "the expression ends".to_string(),
            Token::Operator(":=") => "found `:=`, an assignment, which is not supported".to_string(),
            Token::Keyword(word @ ("await" | "yield")) => format!("found `{word}`, which is not supported"),
            Token::Operator("@") => "found `@`, which is not supported".to_string(),
            _ => {
                let end = self.tokens.get(self.next + 1).map_or(self.text.len(), |(at, _)| *at);
                format!("found `{}`", self.text[self.at()..end].trim())
            }
        };
        Fault::at(self.at(), format!("{found}, expected {expected}"))
    }

    /// Parses one level deeper, within the bound.
    pub fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        self.depth += 1;
        if self.depth > MOST_EXPRESSION_DEPTH {
            let message = format!("the expression has more than {MOST_EXPRESSION_DEPTH} levels");
            return Err(Fault::at(self.at(), message));
        }
        let parsed = parse(self);
        self.depth -= 1;
        parsed
    }

    /// A chain of operators makes a tree as deep as it is long.
    fn lengthened(&mut self, length: &mut usize) -> Result<()> {
        *length += 1;
        if self.depth + *length > MOST_EXPRESSION_DEPTH {
            let message = format!("the expression has more than {MOST_EXPRESSION_DEPTH} operators in a row");
            return Err(Fault::at(self.at(), message));
        }
        Ok(())
    }

    pub fn expression(&mut self) -> Result<Node> {
        self.deeper(|parser| {
            if parser.is_keyword("lambda") {
                return parser.lambda();
            }
            let then = parser.disjunction()?;
            let at = parser.at();
            if !parser.takes_keyword("if") {
                return Ok(then);
            }
            let condition = parser.disjunction()?;
            if !parser.takes_keyword("else") {
                return Err(parser.unexpected("`else`"));
            }
            let other = parser.expression()?;
            Ok(Node { at, kind: Kind::Choice(Box::new((condition, then, other))) })
        })
    }

    fn lambda(&mut self) -> Result<Node> {
        let at = self.at();
        self.advance();
        let mut parameters: Vec<(Rc<str>, Option<Node>)> = Vec::new();
        while !self.is(":") {
            if self.is("*") || self.is("**") || self.is("/") {
                return Err(self.unexpected("a parameter's name; other parameters are not supported"));
            }
            let place = self.at();
            let name = self.name()?;
            let default = if self.takes("=") { Some(self.expression()?) } else { None };
            let is_late = default.is_none() && parameters.last().is_some_and(|(_, default)| default.is_some());
            if is_late || parameters.iter().any(|(known, _)| *known == name) {
                return Err(Fault::at(
                    place,
                    format!("the parameter `{name}` is repeated, or has no default after one that has"),
                ));
            }
            parameters.push((name, default));
            if !self.takes(",") {
                break;
            }
        }
        self.expect(":")?;
        let body = self.expression()?;
        Ok(Node { at, kind: Kind::Lambda(Rc::new(LambdaSyntax { parameters, body })) })
    }

    pub fn disjunction(&mut self) -> Result<Node> {
        let at = self.at();
        let mut parts = vec![self.conjunction()?];
        while self.takes_keyword("or") {
            parts.push(self.conjunction()?);
        }
        Ok(single(parts, |parts| Node { at, kind: Kind::Or(parts) }))
    }

    fn conjunction(&mut self) -> Result<Node> {
        let at = self.at();
        let mut parts = vec![self.inversion()?];
        while self.takes_keyword("and") {
            parts.push(self.inversion()?);
        }
        Ok(single(parts, |parts| Node { at, kind: Kind::And(parts) }))
    }

    fn inversion(&mut self) -> Result<Node> {
        let at = self.at();
        if self.takes_keyword("not") {
            let operand = self.deeper(Self::inversion)?;
            return Ok(Node { at, kind: Kind::Unary(Unary::Not, Box::new(operand)) });
        }
        self.comparison()
    }

    fn comparison(&mut self) -> Result<Node> {
        let first = self.binary(0)?;
        let (start, mut others) = (self.at(), Vec::new());
        loop {
            let at = self.at();
            let Some(operator) = self.compare_operator()? else { break };
            others.push((at, operator, self.binary(0)?));
        }
        if others.is_empty() { Ok(first) } else { Ok(Node { at: start, kind: Kind::Compare(Box::new(first), others) }) }
    }

    fn compare_operator(&mut self) -> Result<Option<Compare>> {
        let operator = match self.peek() {
            Token::Operator("==") => Compare::Equal,
            Token::Operator("!=") => Compare::NotEqual,
            Token::Operator("<") => Compare::Less,
            Token::Operator("<=") => Compare::LessEqual,
            Token::Operator(">") => Compare::Greater,
            Token::Operator(">=") => Compare::GreaterEqual,
            Token::Keyword("in") => Compare::In,
            Token::Keyword("is") => {
                self.advance();
                return Ok(Some(if self.takes_keyword("not") { Compare::IsNot } else { Compare::Is }));
            }
            Token::Keyword("not") => {
                self.advance();
                if !self.takes_keyword("in") {
                    return Err(self.unexpected("`in`"));
                }
                return Ok(Some(Compare::NotIn));
            }
            _ => return Ok(None),
        };
        self.advance();
        Ok(Some(operator))
    }

    /// The operators of one level and all tighter ones.
    pub fn binary(&mut self, level: usize) -> Result<Node> {
        let Some(operators) = LEVELS.get(level) else { return self.factor() };
        let (mut left, mut length) = (self.binary(level + 1)?, 0);
        loop {
            let at = self.at();
            let Some((_, operator)) = operators.iter().find(|(symbol, _)| self.is(symbol)) else { return Ok(left) };
            self.lengthened(&mut length)?;
            self.advance();
            let right = self.binary(level + 1)?;
            left = Node { at, kind: Kind::Binary(*operator, Box::new((left, right))) };
        }
    }

    fn factor(&mut self) -> Result<Node> {
        let at = self.at();
        let operator = match self.peek() {
            Token::Operator("-") => Unary::Minus,
            Token::Operator("+") => Unary::Plus,
            Token::Operator("~") => Unary::Invert,
            _ => return self.power(),
        };
        self.advance();
        let operand = self.deeper(Self::factor)?;
        Ok(Node { at, kind: Kind::Unary(operator, Box::new(operand)) })
    }

    /// `**` binds tighter than a sign before it, and less tightly than one after it.
    fn power(&mut self) -> Result<Node> {
        let base = self.primary()?;
        let at = self.at();
        if !self.takes("**") {
            return Ok(base);
        }
        let exponent = self.deeper(Self::factor)?;
        Ok(Node { at, kind: Kind::Binary(Binary::Power, Box::new((base, exponent))) })
    }

    fn primary(&mut self) -> Result<Node> {
        let (mut left, mut length) = (self.atom()?, 0);
        loop {
            let at = self.at();
            if !(self.is(".") || self.is("(") || self.is("[")) {
                return Ok(left);
            }
            self.lengthened(&mut length)?;
            left = if self.takes(".") {
                let at = self.at();
                Node { at, kind: Kind::Attribute(Box::new(left), self.name()?) }
            } else if self.takes("(") {
                let arguments = self.deeper(Self::arguments)?;
                Node { at, kind: Kind::Call(Box::new(left), arguments) }
            } else {
                self.advance();
                self.deeper(|parser| parser.subscript(at, left))?
            };
        }
    }
}

/// The only node, or one made of several.
fn single(mut parts: Vec<Node>, several: impl FnOnce(Vec<Node>) -> Node) -> Node {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        last => {
            parts.extend(last);
            several(parts)
        }
    }
}

/// The constants that are keywords.
pub(crate) fn keyword_constant(word: &str) -> Option<Literal> {
    match word {
        "True" => Some(Literal::Bool(true)),
        "False" => Some(Literal::Bool(false)),
        "None" => Some(Literal::None),
        _ => None,
    }
}
