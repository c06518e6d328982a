//! A dictionary: entries in the order of insertion, found by key.

use crate::expression::values::value::{Dictionary, Key, Value};
use crate::fault::{Fault, Result};
use num_bigint::BigInt;
use num_traits::FromPrimitive;

impl Key {
    pub fn of(value: &Value) -> Result<Key> {
        Ok(match value {
            Value::None => Key::None,
            Value::Bool(value) => Key::Int(BigInt::from(i32::from(*value))),
            Value::Int(number) => Key::Int(number.clone()),
            Value::Float(number) if number.fract() == 0.0 => match BigInt::from_f64(*number) {
                Some(whole) => Key::Int(whole),
                None => Key::Float(number.to_bits()),
            },
            Value::Float(number) => Key::Float(number.to_bits()),
            Value::Str(text) => Key::Str(text.clone()),
            Value::Tuple(items) => Key::Tuple(items.iter().map(Key::of).collect::<Result<_>>()?),
            other => {
                return Err(Fault::new(format!("a {} cannot be a key, expected an immutable value", other.kind())));
            }
        })
    }
}

impl Dictionary {
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub fn entries(&self) -> &[(Value, Value)] {
        &self.entries
    }

    pub fn keys(&self) -> impl Iterator<Item = &Value> {
        self.entries.iter().map(|(key, _)| key)
    }

    pub fn get(&self, key: &Value) -> Result<Option<&Value>> {
        Ok(self.index.get(&Key::of(key)?).map(|&at| &self.entries[at].1))
    }

    pub fn text_key(&self, key: &str) -> Option<&Value> {
        self.index.get(&Key::Str(key.into())).map(|&at| &self.entries[at].1)
    }

    /// Inserts an entry. An existing key keeps its position and its first form.
    pub fn insert(&mut self, key: Value, value: Value) -> Result<()> {
        match self.index.entry(Key::of(&key)?) {
            std::collections::hash_map::Entry::Occupied(at) => self.entries[*at.get()].1 = value,
            std::collections::hash_map::Entry::Vacant(vacant) => {
                vacant.insert(self.entries.len());
                self.entries.push((key, value));
            }
        }
        Ok(())
    }

    /// Cost: the number of entries.
    pub fn remove(&mut self, key: &Value) -> Result<Option<(Value, Value)>> {
        let Some(at) = self.index.remove(&Key::of(key)?) else { return Ok(None) };
        self.index.values_mut().filter(|place| **place > at).for_each(|place| *place -= 1);
        Ok(Some(self.entries.remove(at)))
    }

    pub fn clear(&mut self) {
        *self = Dictionary::default();
    }

    /// A set of these values.
    pub fn of_keys(keys: impl IntoIterator<Item = Value>) -> Result<Dictionary> {
        let mut set = Dictionary::default();
        for key in keys {
            if set.get(&key)?.is_none() {
                set.insert(key, Value::None)?;
            }
        }
        Ok(set)
    }

    /// The keys of a set in Python's order, if that is defined: small integers are in their own slots of its hash
    /// table. None otherwise.
    pub fn ordered_keys(&self) -> Option<Vec<Value>> {
        let mut keys: Vec<Value> = self.keys().cloned().collect();
        if keys.len() < 2 {
            return Some(keys);
        }
        let mut slots = 8;
        for used in 1..=keys.len() {
            if used * 5 >= (slots - 1) * 3 {
                slots = (used * if used > 50_000 { 2 } else { 4 } + 1).next_power_of_two();
            }
        }
        let place = |key: &Value| key.as_int().and_then(|whole| usize::try_from(whole).ok()).filter(|k| *k < slots);
        if !keys.iter().all(|key| place(key).is_some()) {
            return None;
        }
        keys.sort_by_key(place);
        Some(keys)
    }
}
