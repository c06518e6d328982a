//! A value of a file of JSON or YAML with its path, read as a text, a number, a vector, a pose.

use super::file::{File, Misplaced, Step, unknown_key};
use crate::report::spelling::did_you_mean;
use crate::urdf::vocabulary::list;
use mozzi::SE3;
use serde_json::Value;
use std::fmt::Display;

/// A value that was read, or an error with its place.
pub type Read<T> = std::result::Result<T, Misplaced>;

/// A value and its path in its file: the strict reader of all files of JSON and YAML. A value of another type than the
/// expected one is an error with line and column.
pub struct At<'v> {
    file: &'v File,
    /// The value; null if the file lacks it.
    pub value: &'v Value,
    /// The name of the whole in messages, such as "the robot".
    whole: &'static str,
    path: Vec<Step<'v>>,
}

impl<'v> At<'v> {
    /// The value of a file that describes `whole`, such as "the robot".
    pub fn root(file: &'v File, whole: &'static str) -> Self {
        At { file, value: &file.value, whole, path: Vec::new() }
    }

    fn entry(&self, step: Step<'v>, value: &'v Value) -> At<'v> {
        At { value, path: [self.path.as_slice(), &[step]].concat(), file: self.file, whole: self.whole }
    }

    /// The value of a key; null if there is no such key.
    pub fn get(&self, key: &'v str) -> At<'v> {
        self.entry(Step::Key(key), self.value.get(key).unwrap_or(&Value::Null))
    }

    fn keys(&self) -> impl Iterator<Item = &'v str> {
        self.value.as_object().into_iter().flatten().map(|(key, _)| key.as_str())
    }

    /// Whether it is an object with this key; its value may be null.
    pub fn has(&self, key: &str) -> bool {
        self.value.get(key).is_some()
    }

    /// Line and column in the file, from 1.
    pub fn position(&self) -> (usize, usize) {
        self.file.position(&self.path)
    }

    /// An error for each key that is not known.
    pub fn unknown(&self, known: &[&str]) -> Vec<Misplaced> {
        let error = |key| {
            let path = [self.path.as_slice(), &[Step::Key(key)]].concat();
            self.file.wrong(&path, unknown_key(key, &self.name(), known))
        };
        self.keys().filter(|key| !known.contains(key)).map(error).collect()
    }

    /// An error for each required key that is missing.
    pub fn missing(&self, required: &[&str]) -> Vec<Misplaced> {
        let error = |key: &&str| self.file.wrong(&self.path, format!("`{key}` is missing in {}", self.name()));
        required.iter().filter(|key| !self.has(key)).map(error).collect()
    }

    /// `joints[1].mimic`, or the name of the whole.
    pub fn name(&self) -> String {
        let mut name = String::new();
        for step in &self.path {
            match step {
                Step::Key(key) if name.is_empty() => name += key,
                Step::Key(key) => name += &format!(".{key}"),
                Step::Index(index) => name += &format!("[{index}]"),
            }
        }
        if name.is_empty() { self.whole.to_string() } else { name }
    }

    /// An error at its place.
    ///
    /// # Errors
    /// Always.
    pub fn error<T>(&self, message: impl Display) -> Read<T> {
        Err(self.file.wrong(&self.path, message.to_string()))
    }

    /// "friction is \"x\", expected a number".
    ///
    /// # Errors
    /// Always.
    pub fn wrong<T>(&self, expected: impl Display) -> Read<T> {
        let found: String = self.value.to_string().chars().take(60).collect();
        self.error(format_args!("{} is {found}, expected {expected}", self.name()))
    }

    /// A text.
    ///
    /// # Errors
    /// Another value; likewise for the others.
    pub fn text(&self) -> Read<String> {
        self.value.as_str().map_or_else(|| self.wrong("a text"), |text| Ok(text.to_string()))
    }

    /// One of some words.
    ///
    /// # Errors
    /// As [`text`](Self::text), with the most similar word.
    pub fn word(&self, known: &[&'static str]) -> Read<&'static str> {
        let found = self.value.as_str();
        known.iter().copied().find(|word| Some(*word) == found).map_or_else(
            || {
                let hint = found.and_then(|found| did_you_mean(found, known.iter().copied()));
                let hint = hint.map_or_else(String::new, |hint| format!("; {hint}"));
                self.wrong(format_args!("one of {}{hint}", list(known)))
            },
            Ok,
        )
    }

    /// A number.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn number(&self) -> Read<f64> {
        self.value.as_f64().map_or_else(|| self.wrong("a number"), Ok)
    }

    /// True or false.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn is_true(&self) -> Read<bool> {
        self.value.as_bool().map_or_else(|| self.wrong("true or false"), Ok)
    }

    /// The entries of a list.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn list(&self) -> Read<Vec<At<'v>>> {
        let Some(all) = self.value.as_array() else { return self.wrong("a list") };
        Ok(all.iter().enumerate().map(|(k, value)| self.entry(Step::Index(k), value)).collect())
    }

    /// A list of texts.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn texts(&self) -> Read<Vec<String>> {
        self.list()?.iter().map(At::text).collect()
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn numbers(&self) -> Read<Vec<f64>> {
        self.list()?.iter().map(At::number).collect()
    }

    /// A list of N numbers.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn vector<const N: usize>(&self) -> Read<[f64; N]> {
        self.numbers()?.try_into().or_else(|_| self.wrong(format_args!("{N} numbers")))
    }

    /// N rows of N numbers.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn matrix<const N: usize>(&self) -> Read<[[f64; N]; N]> {
        let all: Vec<[f64; N]> = self.list()?.iter().map(At::vector).collect::<Read<_>>()?;
        all.try_into().or_else(|_| self.wrong(format_args!("{N} rows")))
    }

    /// A configuration, 4 × 4.
    ///
    /// # Errors
    /// As [`text`](Self::text).
    pub fn pose(&self) -> Read<SE3> {
        SE3::from_matrix(self.matrix()?).or_else(|why| self.wrong(format_args!("a configuration: {why}")))
    }

    /// `None` if it is null or there is no such key.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn some<T>(&self, read: impl Fn(&Self) -> Read<T>) -> Read<Option<T>> {
        if self.value.is_null() { Ok(None) } else { read(self).map(Some) }
    }
}
