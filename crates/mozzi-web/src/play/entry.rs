//! Entries of a command.

use serde_json::Value;

pub fn text<'v>(command: &'v Value, key: &str) -> Result<&'v str, String> {
    command[key].as_str().ok_or_else(|| format!("`{key}` is {}, expected a text", command[key]))
}

pub fn number(command: &Value, key: &str) -> Result<f64, String> {
    command[key].as_f64().ok_or_else(|| format!("`{key}` is {}, expected a number", command[key]))
}

pub fn numbers(command: &Value, key: &str) -> Result<Vec<f64>, String> {
    let wrong = || format!("`{key}` is {}, expected a list of numbers", command[key]);
    command[key].as_array().ok_or_else(wrong)?.iter().map(|x| x.as_f64().ok_or_else(wrong)).collect()
}

pub fn three(command: &Value, key: &str) -> Result<[f64; 3], String> {
    let list = numbers(command, key)?;
    list.try_into().map_err(|list: Vec<f64>| format!("`{key}` has {} numbers, expected 3", list.len()))
}
