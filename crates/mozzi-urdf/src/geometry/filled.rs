//! The inertia of the solid that a mesh bounds.

use super::moments::{Filling, moments};
use super::surface::Surface;
use super::{MeshFolders, locate};
use crate::files;
use crate::report::visible::visible;
use mozzi::{SpatialInertia, Vec3};
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::Path;

/// A larger mesh is not read.
const MOST_BYTES: u64 = 64 << 20;

/// The solid that a mesh of the robot in `robot_file` bounds, filled with 1 kg/m³, in the shape's frame. Its file, STL,
/// OBJ or MSH, is found as by [`locate`].
///
/// # Errors
/// The reason why the mesh is not found, not read or no closed surface.
pub fn filled_mesh(robot_file: &Path, mesh: &str, scale: [f64; 3]) -> Result<SpatialInertia, String> {
    let mut surface = scaled_surface(robot_file, mesh, scale, MeshFolders::default())?;
    if scale.iter().product::<f64>() < 0.0 {
        surface.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2)); // a mirrored surface is turned outwards
    }
    let solid = moments(&surface.vertices, &surface.triangles, Filling::Exact)?;
    Ok(SpatialInertia::new(solid.size, solid.center, solid.I))
}

/// The mesh in the shape's frame, found as by [`locate`]; its triangles are as in the file.
pub(crate) fn scaled_surface(
    robot_file: &Path,
    mesh: &str,
    scale: [f64; 3],
    folders: MeshFolders<'_>,
) -> Result<Surface, String> {
    let path = locate(robot_file, mesh, folders).map_err(|why| why.to_string())?;
    let wrong = |why: &dyn Display| format!("mesh {}: {why}", visible(mesh));
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
    let bytes = files::read(&path, MOST_BYTES).map_err(|why| wrong(&why))?;
    let mut surface = Surface::read(&ending, &bytes).map_err(|why| wrong(&why))?;
    surface.vertices.iter_mut().for_each(|v| *v = Vec3([0, 1, 2].map(|k| v.0[k] * scale[k])));
    Ok(surface)
}
