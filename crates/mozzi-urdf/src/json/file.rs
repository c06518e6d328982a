//! A file of JSON: its value, and the line of each entry for messages. A name that is given twice is an error, as the
//! last one would win silently.

use super::position::{self, Place};
use crate::report::spelling::did_you_mean;
use serde_core::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;

/// A step from a value to one of its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'p> {
    /// The value of a key.
    Key(&'p str),
    /// An entry of a list.
    Index(usize),
}

/// A text of JSON, or of YAML, and its value.
#[derive(Debug)]
pub struct File {
    /// Its name in messages.
    pub name: String,
    places: Places,
    /// Its value.
    pub value: Value,
}

#[derive(Debug)]
enum Places {
    /// In this text of JSON.
    Text(String),
    Tree(Place),
}

/// An error in a file of JSON or YAML.
#[derive(Clone, Debug, PartialEq)]
pub struct Misplaced {
    file: String,
    /// Line and column, from 1; none if the error concerns the whole file.
    pub position: Option<(usize, usize)>,
    /// The message.
    pub message: String,
}

impl fmt::Display for Misplaced {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some((line, column)) = self.position {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Misplaced {}

impl Misplaced {
    /// An error that concerns the whole file.
    pub fn whole(file: impl Into<String>, message: impl Into<String>) -> Self {
        Misplaced { file: file.into(), position: None, message: message.into() }
    }

    /// An error at a line and column, from 1.
    pub(crate) fn at(file: &str, position: (usize, usize), message: impl Into<String>) -> Self {
        Misplaced { file: file.to_string(), position: Some(position), message: message.into() }
    }
}

impl File {
    /// From its text. A byte order mark at the start is accepted.
    ///
    /// # Errors
    /// Text that is not JSON, and a name that is given twice in an object.
    pub fn parse(name: &str, text: impl Into<String>) -> Result<Self, Misplaced> {
        let text = text.into();
        let json = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let Once(value) = serde_json::from_str(json).map_err(|error| misread(name, &error))?;
        Ok(File { name: name.to_string(), value, places: Places::Text(text) })
    }

    /// A value whose places are known.
    pub(crate) fn placed(name: &str, value: Value, place: Place) -> Self {
        File { name: name.to_string(), value, places: Places::Tree(place) }
    }

    /// Line and column of an entry, from 1; if there is no such entry, those of the value in which it is missing.
    pub fn position(&self, path: &[Step]) -> (usize, usize) {
        match &self.places {
            Places::Text(text) => position::find(text, path),
            Places::Tree(place) => place.find(path),
        }
    }

    /// A message about an entry.
    pub fn wrong(&self, path: &[Step], message: impl Into<String>) -> Misplaced {
        Misplaced::at(&self.name, self.position(path), message)
    }
}

fn misread(name: &str, error: &serde_json::Error) -> Misplaced {
    let (line, column) = (error.line(), error.column());
    let why = error.to_string();
    let why = why.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&why);
    let message = if error.is_data() { why.to_string() } else { format!("is not valid JSON: {why}") };
    Misplaced::at(name, (line, column), message)
}

/// "`frition` is not an entry of `joints[1]`, did you mean `friction`?", or the list of all known keys.
pub fn unknown_key(key: &str, parent: &str, known: &[&str]) -> String {
    let others = || format!("expected {}", known.join(", "));
    let hint = did_you_mean(key, known.iter().copied()).unwrap_or_else(others);
    format!("`{key}` is not an entry of {parent}, {hint}")
}

struct Once(Value);

impl<'de> Deserialize<'de> for Once {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Values).map(Once)
    }
}

struct Values;

impl<'de> Visitor<'de> for Values {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value of JSON")
    }
    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_bool<E>(self, x: bool) -> Result<Value, E> {
        Ok(x.into())
    }
    fn visit_i64<E>(self, x: i64) -> Result<Value, E> {
        Ok(x.into())
    }
    fn visit_u64<E>(self, x: u64) -> Result<Value, E> {
        Ok(x.into())
    }
    fn visit_f64<E>(self, x: f64) -> Result<Value, E> {
        Ok(x.into())
    }
    fn visit_str<E>(self, x: &str) -> Result<Value, E> {
        Ok(x.into())
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Once(entry)) = entries.next_element()? {
            list.push(entry);
        }
        Ok(list.into())
    }
    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut map = Map::new();
        while let Some(name) = entries.next_key::<String>()? {
            if map.contains_key(&name) {
                return Err(A::Error::custom(format!("`{name}` is given twice")));
            }
            let Once(value) = entries.next_value()?;
            map.insert(name, value);
        }
        Ok(map.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_serde_json_and_each_once() {
        let text = r#"{"a": [1, -2, 3.5, 1e300, null, true, "x"], "b": {"c": {}, "d": []}}"#;
        let Once(value) = serde_json::from_str(text).expect("JSON");
        assert_eq!(value, serde_json::from_str::<Value>(text).expect("JSON"));
        let error = serde_json::from_str::<Once>("{\"a\": {\"p\": 1,\n \"q\": 2, \"p\": 3}}").err().expect("twice");
        assert_eq!(error.to_string(), "`p` is given twice at line 2 column 12");
    }

    #[test]
    fn errors_have_a_line_and_a_byte_order_mark_is_none() {
        let why = |text: &str| File::parse("a.json", text.to_string()).err().map(|error| error.to_string());
        assert_eq!(why("\u{feff}{\"a\": 1}"), None);
        assert_eq!(why("{\"a\": 1,\n \"a\": 2}").as_deref(), Some("a.json:2:4: `a` is given twice"));
        assert_eq!(why("{\"a\":\n }").as_deref(), Some("a.json:2:2: is not valid JSON: expected value"));
        let file = File::parse("a.json", "{\"a\": [1,\n 2]}".to_string()).expect("JSON");
        let wrong = file.wrong(&[Step::Key("a"), Step::Index(1)], "is 2");
        assert_eq!(wrong.to_string(), "a.json:2:2: is 2");
    }
}
