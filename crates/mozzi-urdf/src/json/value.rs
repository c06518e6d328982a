//! Values as JSON. Matrices are lists of rows; NaN and infinity are null, since JSON cannot express them.

use mozzi::SE3;
use mozzi::model::ScrewLists;
use serde_json::{Value, json};

/// A list of numbers.
pub fn vector(values: &[f64]) -> Value {
    values.iter().copied().map(Value::from).collect()
}

/// A matrix by rows.
pub fn rows<const R: usize, const C: usize>(rows: [[f64; C]; R]) -> Value {
    rows.iter().map(|row| vector(row)).collect()
}

/// A configuration, 4 × 4.
pub fn pose(T: SE3) -> Value {
    rows(T.to_matrix())
}

/// The book's lists.
pub fn screws(lists: &ScrewLists) -> Value {
    let axes = |list: &[mozzi::ScrewAxis]| list.iter().map(|A| vector(&A.twist().to_array())).collect::<Value>();
    json!({
        "joints": lists.joints,
        "links": lists.links,
        "parents": lists.parents,
        "M": lists.M.iter().map(|&T| pose(T)).collect::<Value>(),
        "M_relative": lists.M_relative.iter().map(|&T| pose(T)).collect::<Value>(),
        "S": axes(&lists.S),
        "B": lists.end_effector.as_ref().map(|_| axes(&lists.B)),
        "A": axes(&lists.A),
        "G": lists.G.iter().map(|G| rows(G.to_matrix())).collect::<Value>(),
        "end_effector": lists.end_effector.as_ref().map(|(name, T)| json!({ "name": name, "M": pose(*T) })),
    })
}

/// An object over several lines; a list without lists or objects in it takes one line.
pub fn print(value: &Value) -> String {
    let mut text = String::new();
    write(value, 0, &mut text);
    text.push('\n');
    text
}

fn write(value: &Value, depth: usize, text: &mut String) {
    let nested = |value: &Value| matches!(value, Value::Array(list) if !list.is_empty()) || value.is_object();
    let mut lines = |open: char, close: char, entries: Vec<(String, &Value)>| {
        text.push(open);
        for (k, (name, entry)) in entries.iter().enumerate() {
            text.push_str(if k == 0 { "\n" } else { ",\n" });
            text.push_str(&"  ".repeat(depth + 1));
            text.push_str(name);
            write(entry, depth + 1, text);
        }
        text.push('\n');
        text.push_str(&"  ".repeat(depth));
        text.push(close);
    };
    match value {
        Value::Object(map) if !map.is_empty() => {
            lines(
                '{',
                '}',
                map.iter().map(|(name, entry)| (format!("{}: ", Value::from(name.as_str())), entry)).collect(),
            );
        }
        Value::Array(list) if list.iter().any(nested) => {
            lines('[', ']', list.iter().map(|entry| (String::new(), entry)).collect());
        }
        Value::Array(list) => {
            text.push_str(&format!("[{}]", list.iter().map(Value::to_string).collect::<Vec<_>>().join(", ")));
        }
        other => text.push_str(&other.to_string()),
    }
}
