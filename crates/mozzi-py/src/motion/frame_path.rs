//! `mozzi.trajectories.poses_between`: a frame's poses between two given poses.

use super::path::places;
use crate::array::Numbers;
use crate::describe::{pose, refused};
use mozzi::SE3;
use mozzi_motion::trajectories::Shape;
use pyo3::prelude::*;

/// The shape of a frame's path.
///
/// # Errors
/// `ValueError` for another name.
pub fn shape_named(name: &str) -> PyResult<Shape> {
    match name {
        "screw" => Ok(Shape::Screw),
        "straight" => Ok(Shape::Straight),
        other => Err(refused(format!("shape is '{other}', expected 'screw' or 'straight'"))),
    }
}

/// A pose of a frame.
///
/// # Errors
/// `TypeError`, `ValueError` for an invalid pose.
pub fn pose_of(name: &'static str, given: &Bound<'_, PyAny>) -> PyResult<SE3> {
    pose(Numbers::matrix(name, given, "(4, 4)")?).map_err(|error| refused(format!("{name}: {error}")))
}

/// Interpolate between two poses of a frame (Modern Robotics, section 9.2.1).
///
/// Parameters
/// ----------
/// start, goal : array_like, shape (4, 4)
///     T₀ and T₁, in any one frame.
/// s : array_like, shape (...)
///     Places on the path: 0 to 1.
/// shape : {'screw', 'straight'}
///     'screw': T₀e^{[ξ]s} with ξ = log(T₀⁻¹T₁). 'straight': the origin on a straight line, the orientation R₀e^{[ω]s}
///     with ω = log(R₀ᵀR₁).
///
/// Returns
/// -------
/// numpy.ndarray, shape (..., 4, 4)
///     The poses.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> from mozzi.trajectories import poses_between
/// >>> goal = np.eye(4)
/// >>> goal[0, 3] = 2.0
/// >>> poses_between(np.eye(4), goal, 0.25)[:3, 3]
/// array([0.5, 0. , 0. ])
#[pyfunction]
#[pyo3(signature = (start, goal, s, *, shape="screw"))]
pub fn poses_between<'py>(
    py: Python<'py>,
    start: &Bound<'py, PyAny>,
    goal: &Bound<'py, PyAny>,
    s: &Bound<'py, PyAny>,
    shape: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let (shape, T0, T1) = (shape_named(shape)?, pose_of("start", start)?, pose_of("goal", goal)?);
    places(s)?.poses(py, |s| shape.at(T0, T1, s))
}
