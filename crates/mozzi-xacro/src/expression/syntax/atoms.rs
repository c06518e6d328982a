//! Parses the operands of an expression: names, constants, displays, comprehensions, arguments, subscripts.

use crate::expression::syntax::parser::{Parser, keyword_constant};
use crate::expression::syntax::token::Token;
use crate::expression::syntax::{Argument, Clause, Comprehension, Form, Kind, Literal, Node, Target};
use crate::fault::{Fault, Result};
use std::rc::Rc;

impl Parser<'_> {
    pub fn atom(&mut self) -> Result<Node> {
        let at = self.at();
        let kind = match self.peek().clone() {
            Token::Constant(mut value) => {
                self.advance();
                // adjacent strings are joined
                while let (Literal::Str(text), Token::Constant(Literal::Str(next))) = (&value, self.peek()) {
                    value = Literal::Str(format!("{text}{next}").into());
                    self.advance();
                }
                Kind::Constant(value)
            }
            Token::Name(name) => {
                self.advance();
                Kind::Name(name.into())
            }
            Token::Keyword(word) => match keyword_constant(word) {
                Some(value) => {
                    self.advance();
                    Kind::Constant(value)
                }
                None => return Err(self.unexpected("a value")),
            },
            Token::Operator("(") => {
                self.advance();
                return self.deeper(|parser| parser.parenthesis(at));
            }
            Token::Operator("[") => {
                self.advance();
                return self.deeper(|parser| parser.list(at));
            }
            Token::Operator("{") => {
                self.advance();
                return self.deeper(|parser| parser.braces(at));
            }
            Token::Operator("...") => return Err(Fault::at(at, "`...` is not supported")),
            _ => return Err(self.unexpected("a value")),
        };
        Ok(Node { at, kind })
    }

    /// An item of a display: an expression, or `*items`.
    fn item(&mut self) -> Result<Node> {
        let at = self.at();
        if self.takes("*") {
            let items = self.binary(0)?;
            return Ok(Node { at, kind: Kind::Starred(Box::new(items)) });
        }
        self.expression()
    }

    /// The remaining items of a tuple whose first item was read, up to the closing bracket or the end.
    pub fn rest_of_tuple(&mut self, at: usize, first: Node, may_star: bool) -> Result<Node> {
        let mut items = vec![first];
        while self.takes(",") {
            if matches!(self.peek(), Token::End) || self.is(")") || self.is("]") {
                break;
            }
            items.push(if may_star { self.item()? } else { self.expression()? });
        }
        Ok(Node { at, kind: Kind::Tuple(items) })
    }

    fn parenthesis(&mut self, at: usize) -> Result<Node> {
        if self.takes(")") {
            return Ok(Node { at, kind: Kind::Tuple(Vec::new()) });
        }
        let first = self.item()?;
        let inner = if self.begins_clause() {
            self.comprehension(at, Form::Generator, first, None)?
        } else if self.is(",") {
            self.rest_of_tuple(at, first, true)?
        } else {
            no_star(first)?
        };
        self.expect(")")?;
        Ok(inner)
    }

    fn list(&mut self, at: usize) -> Result<Node> {
        if self.takes("]") {
            return Ok(Node { at, kind: Kind::List(Vec::new()) });
        }
        let first = self.item()?;
        let list = if self.begins_clause() {
            self.comprehension(at, Form::List, first, None)?
        } else {
            Node { at, kind: Kind::List(self.rest_of_display(first, "]")?) }
        };
        self.expect("]")?;
        Ok(list)
    }

    fn rest_of_display(&mut self, first: Node, close: &str) -> Result<Vec<Node>> {
        let mut items = vec![first];
        while self.takes(",") && !self.is(close) {
            items.push(self.item()?);
        }
        Ok(items)
    }

    /// A dictionary or a set.
    fn braces(&mut self, at: usize) -> Result<Node> {
        if self.takes("}") {
            return Ok(Node { at, kind: Kind::Dict(Vec::new()) });
        }
        let is_dict = self.is("**");
        let first = if is_dict { None } else { Some(self.item()?) };
        let node = match first {
            Some(first) if !self.is(":") => match self.begins_clause() {
                true => self.comprehension(at, Form::Set, first, None)?,
                false => Node { at, kind: Kind::Set(self.rest_of_display(first, "}")?) },
            },
            first => {
                let entry = self.entry(first)?;
                match entry {
                    (Some(key), value) if self.begins_clause() => {
                        self.comprehension(at, Form::Dict, key, Some(value))?
                    }
                    entry => {
                        let mut entries = vec![entry];
                        while self.takes(",") && !self.is("}") {
                            let key = if self.is("**") { None } else { Some(self.expression()?) };
                            entries.push(self.entry(key)?);
                        }
                        Node { at, kind: Kind::Dict(entries) }
                    }
                }
            }
        };
        self.expect("}")?;
        Ok(node)
    }

    /// `: value` after a key; or, without a key, `**items`.
    fn entry(&mut self, key: Option<Node>) -> Result<(Option<Node>, Node)> {
        match key {
            Some(key) => {
                let key = no_star(key)?;
                self.expect(":")?;
                Ok((Some(key), self.expression()?))
            }
            None => {
                self.expect("**")?;
                Ok((None, self.binary(0)?))
            }
        }
    }

    pub fn begins_clause(&self) -> bool {
        self.is_keyword("for") || self.is_keyword("async")
    }

    /// The clauses after an element.
    pub fn comprehension(&mut self, at: usize, form: Form, element: Node, value: Option<Node>) -> Result<Node> {
        let (element, mut clauses) = (no_star(element)?, Vec::new());
        while self.begins_clause() {
            if self.is_keyword("async") {
                return Err(Fault::at(self.at(), "`async` is not supported"));
            }
            self.advance();
            let target = self.targets()?;
            if !self.takes_keyword("in") {
                return Err(self.unexpected("`in`"));
            }
            let (items, mut conditions) = (self.disjunction()?, Vec::new());
            while self.takes_keyword("if") {
                conditions.push(self.disjunction()?);
            }
            clauses.push(Clause { target, items, conditions });
        }
        Ok(Node { at, kind: Kind::Comprehension(Rc::new(Comprehension { form, element, value, clauses })) })
    }

    /// One name, or several separated by commas.
    fn targets(&mut self) -> Result<Target> {
        let at = self.at();
        let first = self.target()?;
        if !self.is(",") {
            return Ok(first);
        }
        let mut targets = vec![first];
        while self.takes(",") && !self.is_keyword("in") && !self.is(")") && !self.is("]") {
            targets.push(self.target()?);
        }
        Ok(Target::Several(at, targets))
    }

    fn target(&mut self) -> Result<Target> {
        let at = self.at();
        let close = match self.peek() {
            Token::Operator("(") => ")",
            Token::Operator("[") => "]",
            _ => return Ok(Target::Name(self.name()?)),
        };
        self.advance();
        let inner = self.deeper(Self::targets)?;
        self.expect(close)?;
        match inner {
            Target::Name(name) if close == "]" => Ok(Target::Several(at, vec![Target::Name(name)])),
            inner => Ok(inner),
        }
    }

    /// The arguments of a call, up to the closing parenthesis.
    pub fn arguments(&mut self) -> Result<Vec<Argument>> {
        let (mut arguments, mut has_keywords): (Vec<Argument>, bool) = (Vec::new(), false);
        while !self.takes(")") {
            let at = self.at();
            if self.takes("**") {
                arguments.push(Argument::Keywords(self.expression()?));
                has_keywords = true;
            } else if self.takes("*") {
                arguments.push(Argument::Items(self.expression()?));
            } else {
                let value = self.expression()?;
                let name = match &value.kind {
                    Kind::Name(name) if self.is("=") => Some(name.clone()),
                    _ => None,
                };
                if let Some(name) = name {
                    self.advance();
                    let repeated = |a: &Argument| matches!(a, Argument::Keyword(known, _) if *known == name);
                    if arguments.iter().any(repeated) {
                        return Err(Fault::at(at, format!("the argument `{name}` is repeated")));
                    }
                    arguments.push(Argument::Keyword(name, self.expression()?));
                    has_keywords = true;
                } else if self.begins_clause() {
                    let generator = self.comprehension(at, Form::Generator, value, None)?;
                    if !arguments.is_empty() || !self.is(")") {
                        return Err(Fault::at(
                            at,
                            "a generator is not the only argument, expected parentheses around it",
                        ));
                    }
                    arguments.push(Argument::Positional(generator));
                } else if has_keywords {
                    return Err(Fault::at(at, "an argument without a name follows one with a name"));
                } else {
                    arguments.push(Argument::Positional(value));
                }
            }
            if !self.takes(",") {
                self.expect(")")?;
                break;
            }
        }
        Ok(arguments)
    }

    /// The subscript after `[`.
    pub fn subscript(&mut self, at: usize, of: Node) -> Result<Node> {
        let start = self.at();
        let first = if self.is(":") { None } else { Some(self.item()?) };
        if self.is(":") {
            let mut bounds = [first, None, None];
            for bound in 1..3 {
                if self.takes(":") && !self.is(":") && !self.is("]") {
                    bounds[bound] = Some(self.expression()?);
                }
            }
            if self.is(",") {
                return Err(Fault::at(self.at(), "several slices are not supported"));
            }
            self.expect("]")?;
            return Ok(Node { at, kind: Kind::Slice(Box::new((of, bounds))) });
        }
        let Some(index) = first else { return Err(self.unexpected("an index")) };
        let index = match self.is(",") || matches!(index.kind, Kind::Starred(_)) {
            true => self.rest_of_tuple(start, index, true)?,
            false => index,
        };
        self.expect("]")?;
        Ok(Node { at, kind: Kind::Index(Box::new((of, index))) })
    }
}

fn no_star(node: Node) -> Result<Node> {
    match node.kind {
        Kind::Starred(_) => Err(Fault::at(node.at, "`*` is not allowed here")),
        _ => Ok(node),
    }
}
