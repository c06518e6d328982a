//! A file of JSON, in which no name is given twice: the last one would win in silence.

use crate::failure::{Failure, Result};
use crate::input;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};
use std::fmt;

/// A larger file is refused.
const MOST_BYTES: usize = 256 << 20;

pub fn read(file: &str) -> Result<Value> {
    let wrong = |why: String| Failure::wrong(format!("{}: {why}", input::name(file)));
    let text = match file {
        "-" => input::to_text(file, input::robot_text().map_err(|error| input::cannot(file, &error))?.to_vec())?,
        file => input::text(file, MOST_BYTES)?,
    };
    let Once(value) =
        serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|error| match error.is_data() {
            true => wrong(error.to_string()),
            false => wrong(format!("is not valid JSON: {error}")),
        })?;
    Ok(value)
}

struct Once(Value);

impl<'de> Deserialize<'de> for Once {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(Values).map(Once)
    }
}

struct Values;

impl<'de> Visitor<'de> for Values {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value of JSON")
    }
    fn visit_unit<E>(self) -> std::result::Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_bool<E>(self, x: bool) -> std::result::Result<Value, E> {
        Ok(x.into())
    }
    fn visit_i64<E>(self, x: i64) -> std::result::Result<Value, E> {
        Ok(x.into())
    }
    fn visit_u64<E>(self, x: u64) -> std::result::Result<Value, E> {
        Ok(x.into())
    }
    fn visit_f64<E>(self, x: f64) -> std::result::Result<Value, E> {
        Ok(x.into())
    }
    fn visit_str<E>(self, x: &str) -> std::result::Result<Value, E> {
        Ok(x.into())
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> std::result::Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Once(entry)) = entries.next_element()? {
            list.push(entry);
        }
        Ok(list.into())
    }
    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> std::result::Result<Value, A::Error> {
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
}
