//! The inertia of a link's shapes.

use super::RobotFile;
use mozzi::SpatialInertia;
use mozzi_urdf::geometry::{Form, Purpose, filled_mesh};
use std::path::Path;

/// Shapes of a link, filled with 1 kg/m³: those for contacts, those for pictures, and, as MuJoCo counts them, all. None
/// where there is no shape, or where a mesh cannot be read.
pub fn of_link(file: &RobotFile, link: &str) -> Vec<SpatialInertia> {
    let own = |purposes: &'static [Purpose]| {
        let shapes = file.shapes.iter().flatten().filter(move |s| s.link == link && purposes.contains(&s.purpose));
        let solids: Option<Vec<SpatialInertia>> =
            shapes.map(|shape| Some(solid(&shape.form, file.path.as_deref())?.transformed(shape.T))).collect();
        let solids = solids.filter(|list| !list.is_empty());
        solids.map(|list| list.into_iter().fold(SpatialInertia::zero(), |a, b| a + b))
    };
    let all: [&[Purpose]; 3] = [&[Purpose::Collision], &[Purpose::Visual], &[Purpose::Collision, Purpose::Visual]];
    all.into_iter().filter_map(own).collect()
}

/// About its own frame.
fn solid(form: &Form, robot: Option<&Path>) -> Option<SpatialInertia> {
    match form {
        Form::Mesh { file, scale } => filled_mesh(robot?, file, *scale).ok(),
        primitive => Some(primitive.solid()?.of_density(1.0)),
    }
}
