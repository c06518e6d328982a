//! The shapes of a robot, for the picture.

use mozzi::Model;
use mozzi_urdf::geometry::{Form, Purpose, Shape};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Those that are drawn: visual shapes; of a link without any, its collision shapes. A mesh is named by its address in
/// the robot's file.
pub fn drawn(model: &Model, shapes: &[Shape]) -> Value {
    let seen: BTreeSet<&str> =
        shapes.iter().filter(|shape| shape.purpose == Purpose::Visual).map(|shape| &*shape.link).collect();
    let is_drawn = |shape: &&Shape| shape.purpose == Purpose::Visual || !seen.contains(&*shape.link);
    let frame = |link: &str| model.frames().position(|(_, known)| known == link);
    let one = |shape: &Shape| {
        let mesh = match &shape.form {
            Form::Mesh { file, .. } => Some(file),
            _ => None,
        };
        Some(json!({
            "frame": frame(&shape.link)?, "use": shape.purpose.name(), "T": shape.T.to_matrix()[..3].concat(),
            "kind": shape.form.name(), "size": shape.form.size(), "address": mesh, "color": shape.color,
        }))
    };
    shapes.iter().filter(is_drawn).filter_map(one).collect()
}
