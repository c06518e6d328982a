//! Values as JSON. Matrices are lists of rows; NaN and infinity are null, since JSON cannot express them.

use crate::failure::{Failure, Result};
use mozzi::{Base, Model};
pub use mozzi_urdf::json::{pose, print, rows, screws, vector};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

/// # Errors
/// If standard output would get both JSON and a table.
pub fn unless_rows(is_json: bool, out: Option<&str>) -> Result<()> {
    match is_json && out == Some("-") {
        true => Err(Failure::wrong("--json and --out - both write to standard output, expected one of them")),
        false => Ok(()),
    }
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
