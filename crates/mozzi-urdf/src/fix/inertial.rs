//! New numbers of an `<inertial>`, in as many digits as they have.

use crate::edit::element::Editor;
use mozzi::linalg::Sym3;
use mozzi::{SE3, SpatialInertia, Vec3};

pub(super) use crate::edit::inertial::{Inertial, Numbers};
pub(super) use crate::urdf::inertial::MOMENTS;

impl<'a> Inertial<'a> {
    /// Writes the numbers that differ, and lists them.
    pub(super) fn write(&self, new: &Numbers) -> (Editor<'a>, String) {
        let mut editor = Editor::new(self.tag.text);
        let changes = self.set(new, shortest, &mut editor);
        (editor, changes.join(", "))
    }
}

/// A number without the last digits, which rounding changed: those that fifteen digits give.
pub(super) fn shortest(x: f64) -> String {
    let rounded = format!("{x:.14e}").parse::<f64>().unwrap_or(x);
    let is_plain = rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs());
    if is_plain { format!("{}", rounded + 0.0) } else { format!("{rounded:e}") }
}

/// (x² + y² + z²) E − r rᵀ: the moments of 1 kg at r about the origin.
pub(super) fn of_point(r: Vec3) -> Sym3 {
    SpatialInertia::point_mass(1.0, r).transformed(SE3::identity()).I
}
