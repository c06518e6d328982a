//! Values as JSON. Matrices are lists of rows; NaN and infinity are null, since JSON cannot express them.

use mozzi::model::ScrewLists;
use mozzi::{Base, Model, SE3};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

pub fn vector(values: &[f64]) -> Value {
    values.iter().copied().map(Value::from).collect()
}

/// An array by rows: a number, a list, or lists of lists.
pub fn nested(shape: &[usize], values: &[f64]) -> Value {
    match shape {
        [] => values.first().copied().into(),
        [_] => vector(values),
        [_, rest @ ..] => {
            values.chunks_exact(rest.iter().product::<usize>().max(1)).map(|entry| nested(rest, entry)).collect()
        }
    }
}

pub fn dvector(values: &DVector<f64>) -> Value {
    vector(values.as_slice())
}

pub fn matrix(M: &DMatrix<f64>) -> Value {
    M.row_iter().map(|row| row.iter().copied().map(Value::from).collect::<Value>()).collect()
}

pub fn rows<const R: usize, const C: usize>(rows: [[f64; C]; R]) -> Value {
    rows.iter().map(|row| vector(row)).collect()
}

pub fn pose(T: SE3) -> Value {
    rows(T.to_matrix())
}

/// "fixed" or "floating".
pub fn base(model: &Model) -> &'static str {
    match model.base() {
        Base::Fixed => "fixed",
        Base::Floating => "floating",
    }
}

pub fn names<'n>(names: impl Iterator<Item = &'n str>) -> Value {
    names.map(Value::from).collect()
}

/// An object about a robot: its name, the names of its joints, positions and velocities, then these entries.
pub fn of_robot(model: &Model, entries: Value) -> Value {
    let mut object = json!({
        "robot": model.description().name,
        "joints": names(model.joint_names()),
        "base": base(model),
        "positions": names(model.position_names()),
        "velocities": names(model.velocity_names()),
    });
    if let (Value::Object(object), Value::Object(entries)) = (&mut object, entries) {
        object.extend(entries);
    }
    object
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
