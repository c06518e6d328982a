//! Constraints and motors in a file of their own, for robots whose own file describes a tree only.
//!
//! # mozzi's format
//! JSON, or YAML with the same content:
//!
//! ```json
//! {"constraints": [
//!    {"name": "foot", "kind": "point", "a": {"frame": null, "xyz": [0.3, 0.1, 0]}, "b": {"frame": "LF_FOOT"}},
//!    {"name": "rod", "kind": "distance", "length": 0.4, "a": {"frame": "crank"}, "b": {"frame": "rocker"}},
//!    {"name": "gear", "kind": "joint", "joint": "j2", "source": "j1", "polynomial": [0, -2]}],
//!  "motors": ["j1"]}
//! ```
//!
//! - `kind` is `point`, `weld`, `hinge`, `distance` (with a `length`, m), `rolling` (with a `radius`, m) or `joint`:
//!   see [`Closure`](mozzi::model::description::Closure). All rows are in the axes of {a}.
//! - An anchor is a `frame` (a link or frame of the robot; null is {s}) and its configuration in it, the identity by
//!   default: `xyz` (m) and `rpy` (roll, pitch, yaw, rad), or the 4 × 4 matrix `T`.
//! - A `joint` has up to five coefficients, θ_joint = Σ c_k θ_sourceᵏ; without `source`, one: the position at which the
//!   joint is held. For a sum of several joints, `joint` or `source` is a list: `[{"joint": "j2", "ratio": 0.5}, …]`.
//! - `motors` names the joints that have motors; without it, all have.
//!
//! # robot.yaml
//! The format of Gepetto's parallel robots: `closed_loop` lists pairs of frames that coincide, `type` is `6d` (a weld,
//! the default) or `3d` (a point) for each pair, `name_mot` names the motors, or a part of their names. A name that is
//! not a frame's is a joint's, and means the frame of its child. `joint_name` and `joint_type` make joints of the
//! robot's file spherical or fixed. A motor of a mimic joint drives the joint that it follows.
//!
//! Unknown and missing keys are errors, and so are aliases and tags of YAML. Every error has its line and column.

mod closed_loop;
mod entry;
mod file;
mod yaml;

pub(crate) use entry::constraint;
pub use file::ConstraintsError;

use mozzi::Description;
use mozzi::model::description::{Anchor, Constraint, ConstraintKind, Gear};
use serde_json::{Value, json};
use std::path::Path;

/// The robot with the constraints of a file added, and its motors.
///
/// # Errors
/// [`ConstraintsError::File`] if it cannot be read, else as [`parse`].
pub fn read(path: impl AsRef<Path>, robot: Description) -> Result<Description, ConstraintsError> {
    let path = path.as_ref();
    let text = file::text(path).map_err(|source| ConstraintsError::File { path: path.to_path_buf(), source })?;
    parse(&path.to_string_lossy(), &text, robot)
}

/// The robot with the constraints of a text added, and its motors. Errors use the name as the file's.
///
/// # Errors
/// [`ConstraintsError::Refused`]: the first error of the text, or all of the robot with its constraints.
pub fn parse(file_name: &str, text: &str, robot: Description) -> Result<Description, ConstraintsError> {
    file::add(file_name, text, robot)
}

/// The constraints and motors of a robot in mozzi's format, with all digits.
pub fn write(robot: &Description) -> String {
    let entries: Value = robot.constraints.iter().map(value).collect();
    let mut all = json!({ "constraints": entries });
    if let Some(motors) = &robot.motors {
        all["motors"] = json!(motors);
    }
    all.to_string()
}

fn value(constraint: &Constraint) -> Value {
    let kind = constraint.kind_name();
    let anchor = |anchor: &Anchor| json!({ "frame": anchor.frame, "T": anchor.T.to_matrix() });
    match &constraint.kind {
        ConstraintKind::Joint { joints, source, polynomial } => json!({
            "name": constraint.name, "kind": kind, "joint": sum(joints), "source": sum(source), "polynomial": polynomial,
        }),
        ConstraintKind::Frames { a, b, closure } => {
            let mut entry = json!({ "name": constraint.name, "kind": kind, "a": anchor(a), "b": anchor(b) });
            if let Some((key, length)) = entry::length_key(kind).zip(closure.length()) {
                entry[key] = json!(length);
            }
            entry
        }
    }
}

/// A joint's name; several are a list with their ratios.
fn sum(gears: &[Gear]) -> Value {
    match gears {
        [] => Value::Null,
        [Gear { joint, ratio: 1.0 }] => json!(joint),
        _ => crate::json::gears(gears),
    }
}
