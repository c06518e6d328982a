//! The inertia of the solid that a mesh bounds.

use super::locate;
use super::moments::{Filling, moments};
use super::surface::Surface;
use crate::files;
use mozzi::{SpatialInertia, Vec3};
use std::path::Path;

/// A larger mesh is not read.
const MOST_BYTES: u64 = 64 << 20;

/// The solid that a mesh of the robot in `robot_file` bounds, filled with 1 kg/m³, in the shape's frame. Its file, STL,
/// OBJ or MSH, is found as by [`locate`].
///
/// # Errors
/// The reason why the mesh is not found, not read or no closed surface.
pub fn filled_mesh(robot_file: &Path, mesh: &str, scale: [f64; 3]) -> Result<SpatialInertia, String> {
    let path = locate(robot_file, mesh, None).map_err(|error| error.to_string())?;
    let format = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let file = files::read(&path, MOST_BYTES).map_err(|error| error.to_string())?;
    let mut surface = Surface::read(&format, &file)?;
    surface.vertices.iter_mut().for_each(|v| *v = Vec3([0, 1, 2].map(|k| v.0[k] * scale[k])));
    if scale.iter().product::<f64>() < 0.0 {
        surface.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2)); // a mirrored surface is turned outwards
    }
    let solid = moments(&surface.vertices, &surface.triangles, Filling::Exact)?;
    Ok(SpatialInertia::new(solid.size, solid.center, solid.I))
}
