//! YAML, and so JSON, as a tree of values with their places.

use saphyr_parser::{Event, Parser, ScalarStyle, Span};
use std::collections::BTreeSet;

/// Deeper nesting is refused.
const MOST_DEPTH: usize = 32;

/// A value and where it begins: line and column, from 1.
#[derive(Clone, Debug, Default)]
pub struct Node {
    pub place: (usize, usize),
    pub value: Value,
}

#[derive(Clone, Debug, Default)]
pub enum Value {
    #[default]
    Null,
    Number(f64),
    Text(String),
    /// `true` or `false`.
    Flag(bool),
    List(Vec<Node>),
    /// Keys in the order of the file, with their places.
    Map(Vec<(String, (usize, usize), Node)>),
}

/// Why a text is not a valid tree, and the place.
pub type Wrong = ((usize, usize), String);

/// The only document of a text.
pub fn parse(text: &str) -> Result<Node, Wrong> {
    let mut events = Events { parser: Parser::new_from_str(text), last: (1, 1) };
    loop {
        match events.next()? {
            (Event::StreamStart | Event::DocumentStart(_) | Event::Nothing, _) => {}
            (Event::StreamEnd, place) => return Err((place, "the file has no content".to_string())),
            (event, place) => {
                let root = events.node(event, place, 0)?;
                return match events.next()? {
                    (Event::DocumentEnd, _) => match events.next()? {
                        (Event::StreamEnd, _) => Ok(root),
                        (_, place) => Err((place, "a second document begins here, expected one".to_string())),
                    },
                    (_, place) => Err((place, "expected the end of the file".to_string())),
                };
            }
        }
    }
}

struct Events<'t> {
    parser: Parser<'t, saphyr_parser::StrInput<'t>>,
    last: (usize, usize),
}

impl<'t> Events<'t> {
    fn next(&mut self) -> Result<(Event<'t>, (usize, usize)), Wrong> {
        let place = |span: &Span| (span.start.line(), span.start.col() + 1);
        match self.parser.next_event() {
            Some(Ok((event, span))) => {
                self.last = place(&span);
                Ok((event, self.last))
            }
            Some(Err(error)) => {
                let at = (error.marker().line(), error.marker().col() + 1);
                Err((at, format!("is not valid YAML: {}", error.info())))
            }
            None => Ok((Event::StreamEnd, self.last)),
        }
    }

    fn node(&mut self, event: Event<'t>, place: (usize, usize), depth: usize) -> Result<Node, Wrong> {
        if depth > MOST_DEPTH {
            return Err((place, format!("more than {MOST_DEPTH} nested values")));
        }
        let value = match event {
            Event::Scalar(.., Some(_)) | Event::SequenceStart(_, Some(_)) | Event::MappingStart(_, Some(_)) => {
                return Err((place, "has a tag, expected a plain value".to_string()));
            }
            Event::Scalar(text, style, ..) => scalar(&text, style),
            Event::SequenceStart(..) => {
                let mut list = Vec::new();
                loop {
                    match self.next()? {
                        (Event::SequenceEnd, _) => break Value::List(list),
                        (event, place) => list.push(self.node(event, place, depth + 1)?),
                    }
                }
            }
            Event::MappingStart(..) => {
                let (mut map, mut seen) = (Vec::new(), BTreeSet::new());
                loop {
                    let (event, place) = self.next()?;
                    let key = match event {
                        Event::MappingEnd => break Value::Map(map),
                        Event::Scalar(text, ..) => text.into_owned(),
                        _ => return Err((place, "a key is a list or a map, expected a word".to_string())),
                    };
                    if !seen.insert(key.clone()) {
                        return Err((place, format!("`{}` is given twice", crate::urdf::vocabulary::shown(&key))));
                    }
                    let (event, at) = self.next()?;
                    let value = self.node(event, at, depth + 1)?;
                    map.push((key, place, value));
                }
            }
            Event::Alias(_) => return Err((place, "is an alias, expected the value itself".to_string())),
            _ => return Err((place, "expected a value".to_string())),
        };
        Ok(Node { place, value })
    }
}

/// By YAML's core schema; hexadecimal, octal, infinite numbers and NaN remain texts.
fn scalar(text: &str, style: ScalarStyle) -> Value {
    if style != ScalarStyle::Plain {
        return Value::Text(text.to_string());
    }
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
    match text {
        "" | "~" | "null" | "Null" | "NULL" => Value::Null,
        "true" | "True" | "TRUE" => Value::Flag(true),
        "false" | "False" | "FALSE" => Value::Flag(false),
        _ => match text.parse::<f64>() {
            Ok(x) if is_number && x.is_finite() => Value::Number(x),
            _ => Value::Text(text.to_string()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_types_and_places() {
        let root = parse("# a comment\na: [1, -2.5e-3, null]\n\"b c\":\n  - x\n  - '1'\n").expect("YAML");
        assert_eq!(
            format!("{:?}", root.value),
            format!(
                "{:?}",
                Value::Map(vec![
                    (
                        "a".into(),
                        (2, 1),
                        Node {
                            place: (2, 4),
                            value: Value::List(vec![
                                Node { place: (2, 5), value: Value::Number(1.0) },
                                Node { place: (2, 8), value: Value::Number(-2.5e-3) },
                                Node { place: (2, 17), value: Value::Null },
                            ])
                        }
                    ),
                    (
                        "b c".into(),
                        (3, 1),
                        Node {
                            place: (4, 3),
                            value: Value::List(vec![
                                Node { place: (4, 5), value: Value::Text("x".into()) },
                                Node { place: (5, 5), value: Value::Text("1".into()) },
                            ])
                        }
                    ),
                ])
            )
        );
    }

    #[test]
    fn what_is_no_tree_of_values_is_refused_at_its_place() {
        let deep = "[".repeat(100) + &"]".repeat(100);
        for (text, place, why) in [
            ("", (1, 1), "no content"),
            ("a: 1\na: 2", (2, 1), "`a` is given twice"),
            ("a: &x 1\nb: *x", (2, 4), "is an alias"),
            ("a: !!str 1", (1, 4), "has a tag"),
            ("a: 1\n---\nb: 2", (2, 1), "a second document"),
            ("[1, 2]: 3", (1, 1), "expected a word"),
            (&deep, (1, 34), "more than 32"),
            ("{\"a\": [1, 2}", (1, 12), "not valid YAML"),
        ] {
            let (at, found) = parse(text).expect_err(text);
            assert!(at == place && found.contains(why), "{text}: {at:?} {found}");
        }
    }
}
