//! A quantity's frame, task or point, in words and as JSON.

use crate::json;
use crate::numbers::TWIST;
use crate::quantity::hyphenated;
use crate::task;
use crate::text::tuple;
use mozzi::quantities::{Of, Query};
use mozzi::{Model, TaskFrame};
use serde_json::{Map, Value, json};

/// The quantity's name with its frame, task or point.
pub fn object(query: Query, model: &Model) -> Map<String, Value> {
    let (of, subject) = (query.declaration().of, query.subject);
    let mut object = Map::from_iter([("quantity".into(), hyphenated(query.name()).into())]);
    if let Some(frame) = subject.frame {
        object.insert("frame".into(), model.frame_name(frame).into());
    }
    if of == Of::Task {
        object.insert("coordinates".into(), task::name(subject.coordinates).into());
        object.insert("rows".into(), json!(subject.rows));
    }
    if of == Of::Point {
        object.insert("about".into(), json::vector(&subject.point.0));
    }
    object
}

/// " of `tool0`"; nothing for a quantity of the robot itself.
pub fn words(query: Query, model: &Model) -> String {
    let subject = query.subject;
    let frame = subject.frame.map(|frame| format!(" of `{}`", model.frame_name(frame))).unwrap_or_default();
    match query.declaration().of {
        Of::Robot | Of::Frame => frame,
        Of::Task => {
            let rows: Vec<&str> = subject.rows.iter().map(|&row| TWIST[row]).collect();
            let axes = if subject.coordinates == TaskFrame::Body { "its own coordinates" } else { "{s}" };
            format!("{frame}, rows {} in {axes}", rows.join(" "))
        }
        Of::Point => format!(" about {} m", tuple(&subject.point.0)),
    }
}
