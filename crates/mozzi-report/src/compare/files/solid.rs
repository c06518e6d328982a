//! The inertia of a link's shapes.

use super::RobotFile;
use mozzi::SpatialInertia;
use mozzi_urdf::geometry::{Form, Purpose, filled_mesh};
use std::path::Path;

/// Shapes of a link, filled with 1 kg/m³: those for contacts, else those for pictures. None without a shape, or if a
/// mesh cannot be read.
pub fn of_link(file: &RobotFile, link: &str) -> Option<SpatialInertia> {
    let own = |purpose: Purpose| file.shapes.iter().flatten().filter(move |s| s.link == link && s.purpose == purpose);
    let purpose = if own(Purpose::Collision).next().is_some() { Purpose::Collision } else { Purpose::Visual };
    let solids: Option<Vec<SpatialInertia>> =
        own(purpose).map(|shape| Some(solid(&shape.form, file.path.as_deref())?.transformed(shape.T))).collect();
    solids.filter(|list| !list.is_empty()).map(|list| list.into_iter().fold(SpatialInertia::zero(), |a, b| a + b))
}

/// About its own frame.
fn solid(form: &Form, robot: Option<&Path>) -> Option<SpatialInertia> {
    match form {
        Form::Mesh { file, scale } => filled_mesh(robot?, file, *scale).ok(),
        primitive => Some(primitive.solid()?.of_density(1.0)),
    }
}
