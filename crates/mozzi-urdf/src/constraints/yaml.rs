//! YAML, and so JSON, as a value with the place of each entry.

use crate::json::{File, Misplaced, Place};
use saphyr_parser::{Event, Parser, ScalarStyle, Span};
use serde_json::{Map, Value};

/// Deeper nesting is refused.
const MOST_DEPTH: usize = 32;

/// Why a text is not a valid tree, and the place.
type Wrong = ((usize, usize), String);

/// The only document of a text.
pub fn parse(name: &str, text: &str) -> Result<File, Misplaced> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (value, place) = document(text).map_err(|(at, why)| Misplaced::at(name, at, why))?;
    Ok(File::placed(name, value, place))
}

fn document(text: &str) -> Result<(Value, Place), Wrong> {
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

    fn node(&mut self, event: Event<'t>, at: (usize, usize), depth: usize) -> Result<(Value, Place), Wrong> {
        if depth > MOST_DEPTH {
            return Err((at, format!("more than {MOST_DEPTH} nested values")));
        }
        let mut place = Place { at, ..Place::default() };
        let value = match event {
            Event::Scalar(.., Some(_)) | Event::SequenceStart(_, Some(_)) | Event::MappingStart(_, Some(_)) => {
                return Err((at, "has a tag, expected a plain value".to_string()));
            }
            Event::Scalar(text, style, ..) => scalar(&text, style),
            Event::SequenceStart(..) => {
                let mut list = Vec::new();
                loop {
                    match self.next()? {
                        (Event::SequenceEnd, _) => break Value::Array(list),
                        (event, at) => {
                            let (value, entry) = self.node(event, at, depth + 1)?;
                            list.push(value);
                            place.entries.push(entry);
                        }
                    }
                }
            }
            Event::MappingStart(..) => {
                let mut map = Map::new();
                loop {
                    let (event, at) = self.next()?;
                    let key = match event {
                        Event::MappingEnd => break Value::Object(map),
                        Event::Scalar(text, ..) => text.into_owned(),
                        _ => return Err((at, "a key is a list or a map, expected a word".to_string())),
                    };
                    if map.contains_key(&key) {
                        return Err((at, format!("`{}` is given twice", crate::urdf::vocabulary::shown(&key))));
                    }
                    let (event, start) = self.next()?;
                    let (value, entry) = self.node(event, start, depth + 1)?;
                    place.entries.push(Place { at, ..entry });
                    place.keys.push(key.clone());
                    map.insert(key, value);
                }
            }
            Event::Alias(_) => return Err((at, "is an alias, expected the value itself".to_string())),
            _ => return Err((at, "expected a value".to_string())),
        };
        Ok((value, place))
    }
}

/// By YAML's core schema; hexadecimal, octal, infinite numbers and NaN remain texts.
fn scalar(text: &str, style: ScalarStyle) -> Value {
    if style != ScalarStyle::Plain {
        return Value::from(text);
    }
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
    match text {
        "" | "~" | "null" | "Null" | "NULL" => Value::Null,
        "true" | "True" | "TRUE" => Value::Bool(true),
        "false" | "False" | "FALSE" => Value::Bool(false),
        _ => match (text.parse::<i64>(), text.parse::<f64>()) {
            (Ok(n), _) => Value::from(n),
            (_, Ok(x)) if is_number && x.is_finite() => Value::from(x),
            _ => Value::from(text),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::Step::{Index, Key};
    use serde_json::json;

    #[test]
    fn values_have_types_and_places() {
        let file = parse("a.yaml", "# a comment\na: [1, -2.5e-3, null]\n\"b c\":\n  - x\n  - '1'\n").expect("YAML");
        assert_eq!(file.value, json!({ "a": [1, -2.5e-3, null], "b c": ["x", "1"] }));
        for (path, place) in [
            (&[][..], (2, 1)),
            (&[Key("a")], (2, 1)),
            (&[Key("a"), Index(1)], (2, 8)),
            (&[Key("a"), Index(9)], (2, 1)),
            (&[Key("b c")], (3, 1)),
            (&[Key("b c"), Index(0)], (4, 5)),
            (&[Key("b c"), Index(1)], (5, 5)),
        ] {
            assert_eq!(file.position(path), place, "{path:?}");
        }
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
            let error = parse("a.yaml", text).expect_err(text);
            assert!(error.position == Some(place) && error.message.contains(why), "{text}: {error}");
        }
    }
}
