//! Text with `${expressions}` and `$(substitutions)`.

use crate::expander::{Expander, Names};
use crate::expression::{self, Value, evaluate, text_of};
use crate::fault::{Fault, Result};
use crate::place::Place;
use crate::scope::Scope;
use crate::space::is_space;
use std::rc::Rc;

/// A piece of a text.
enum Piece<'t> {
    Text(&'t str),
    /// The content of `${…}`.
    Expression(&'t str),
    /// The content of `$(…)`.
    Substitution(&'t str),
}

/// The first piece of a text, and its length. `$$${` is an escape for `$${`.
fn piece(text: &str) -> Result<(Piece<'_>, usize)> {
    let dollars = text.bytes().take_while(|b| *b == b'$').count();
    let after = text.as_bytes().get(dollars);
    if dollars >= 2 && matches!(after, Some(b'{' | b'(')) {
        return Ok((Piece::Text(&text[1..dollars + 1]), dollars + 1));
    }
    match (dollars, after) {
        (0, _) => {
            let end = text.find('$').unwrap_or(text.len());
            Ok((Piece::Text(&text[..end]), end))
        }
        (1, None) => Ok((Piece::Text(text), 1)),
        (1, Some(b'{')) => match text.find('}') {
            Some(end) => Ok((Piece::Expression(&text[2..end]), end + 1)),
            None => Err(Fault::at(0, "`${` is never closed, expected a `}`")),
        },
        (1, Some(b'(')) => match text.find(')') {
            Some(end) => Ok((Piece::Substitution(&text[2..end]), end + 1)),
            None => Err(Fault::at(0, "`$(` is never closed, expected a `)`")),
        },
        (1, Some(_)) => {
            let end = text[1..].find(['{', '(', '$']).map_or(text.len(), |at| at + 1);
            Ok((Piece::Text(&text[..end]), end))
        }
        _ => Err(Fault::at(0, "`$$` stands for a `$` before `{` or `(` only, expected one `$`")),
    }
}

impl Expander<'_> {
    /// The value of a text: that of its only piece, or all pieces joined. An error has its place in the text.
    pub fn evaluate(&self, text: &Rc<str>, scope: &Rc<Scope>, place: &Place) -> Result<Value> {
        if !text.contains('$') {
            return Ok(Value::Str(text.clone()));
        }
        self.pieces(text, scope).map_err(|fault| self.placed(fault, text, place))
    }

    /// As [`evaluate`](Self::evaluate), as text.
    pub fn evaluate_text(&self, text: &Rc<str>, scope: &Rc<Scope>, place: &Place) -> Result<Rc<str>> {
        match self.evaluate(text, scope, place)? {
            Value::Str(text) => Ok(text),
            other => text_of(&self.budget, &other).map(Rc::from).map_err(|fault| self.placed(fault, text, place)),
        }
    }

    /// Adds the place in the file to the error, if the file contains the text as it is.
    pub fn placed(&self, mut fault: Box<Fault>, text: &str, place: &Place) -> Box<Fault> {
        if fault.place.is_none() {
            let mut place = place.clone();
            let files = self.files.borrow();
            let raw = files.get(place.file as usize).and_then(|file| file.text.get(place.span()));
            if let (Some(at), Some(raw)) = (fault.at.take(), raw)
                && raw == text
                && at <= raw.len()
            {
                place.start += at as u32;
                place.end = place.start + raw[at..].chars().next().map_or(0, |c| c.len_utf8() as u32);
            }
            fault.place = Some(place);
        }
        fault
    }

    pub fn pieces(&self, text: &str, scope: &Rc<Scope>) -> Result<Value> {
        let (mut joined, mut first, mut at, mut count) = (String::new(), None, 0, 0);
        while at < text.len() {
            let (piece, length) = piece(&text[at..]).map_err(|fault| fault.further(at))?;
            let value = match piece {
                Piece::Text(text) => Ok(Value::text(text)),
                Piece::Expression(inner) => self.expression(inner, scope),
                Piece::Substitution(inner) => self.substitution(inner, scope),
            };
            let value = value.map_err(|fault| match fault.at {
                Some(_) => fault.further(at),
                None => fault.or_at(at),
            })?;
            count += 1;
            match count {
                1 => first = Some(value),
                _ => {
                    if let Some(first) = first.take() {
                        joined = text_of(&self.budget, &first)?;
                    }
                    joined.push_str(&text_of(&self.budget, &value)?);
                }
            }
            at += length;
        }
        if count > 1 {
            self.budget.text(joined.len())?;
        }
        Ok(first.unwrap_or_else(|| Value::text(joined)))
    }

    /// Evaluates the content of `${…}`; places refer to the surrounding text.
    fn expression(&self, written: &str, scope: &Rc<Scope>) -> Result<Value> {
        let inner = match written.contains('$') {
            true => match self.pieces(written, scope).map_err(|fault| fault.further(2))? {
                Value::Str(text) => text.to_string(),
                other => return Err(Fault::new(format!("the expression is {}, expected text", other.kind()))),
            },
            false => written.to_string(),
        };
        let trimmed = inner.trim_matches(is_space);
        let known = self.expressions.borrow().get(trimmed).cloned();
        let lead = 2 + inner.find(trimmed).unwrap_or(0);
        let place = |fault: Box<Fault>| match inner == written {
            true => fault.further(lead),
            false => Box::new(Fault { at: None, ..*fault }),
        };
        let tree = match known {
            Some(tree) => tree,
            None => {
                self.budget.spend(trimmed.len() as u64)?;
                let tree = Rc::new(expression::parse(trimmed).map_err(place)?);
                self.expressions.borrow_mut().insert(trimmed.into(), tree.clone());
                tree
            }
        };
        let names = Names { expander: self, scope };
        // a missing file inside another expression is an error of that expression
        evaluate(&names, &tree).map_err(|fault| {
            let is_missing_file = fault.is_missing_file && fault.place.is_none();
            place(Box::new(Fault { is_missing_file, ..*fault }))
        })
    }
}
