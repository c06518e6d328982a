//! The goal of a frame, for one target or for many: from Python's `pose`, `position` or `orientation`.

use crate::arguments::Given;
use crate::array::{Numbers, wrong_shape};
use crate::describe::pose;
use crate::failure::place;
use mozzi::{Mat3, SO3, Vec3};
use mozzi_motion::Goal;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The part of a frame's pose that is the goal.
#[derive(Clone, Copy)]
enum Kind {
    Pose,
    Position,
    Orientation,
}

/// The targets as one array, matrices or points along its last axes.
pub struct Goals<'py> {
    kind: Kind,
    pub numbers: Numbers<'py>,
}

impl<'py> Goals<'py> {
    /// From the one argument that was given.
    ///
    /// # Errors
    /// `ValueError` for no goal, for several, and for a wrong shape; `TypeError`.
    pub fn new(pose: Given<'_, 'py>, position: Given<'_, 'py>, orientation: Given<'_, 'py>) -> PyResult<Self> {
        let all = [
            (Kind::Pose, "pose", pose, "(..., 4, 4)"),
            (Kind::Position, "position", position, "(..., 3): m"),
            (Kind::Orientation, "orientation", orientation, "(..., 3, 3)"),
        ];
        let given: Vec<_> =
            all.into_iter().filter_map(|(kind, name, x, shape)| Some((kind, name, x?, shape))).collect();
        let &[(kind, name, given, expected)] = &given[..] else {
            let found = given.iter().map(|(_, name, ..)| *name).collect::<Vec<_>>().join(" and ");
            let found = if found.is_empty() { "nothing" } else { &found };
            return Err(PyValueError::new_err(format!(
                "the goal is given by {found}, expected one of pose, position and orientation"
            )));
        };
        let numbers = Numbers::new(name, given)?;
        let goals = Goals { kind, numbers };
        let fits = match (goals.kind, &goals.numbers.shape[..]) {
            (Kind::Pose, [.., rows, columns]) => (*rows, *columns) == (4, 4),
            (Kind::Orientation, [.., rows, columns]) => (*rows, *columns) == (3, 3),
            (Kind::Position, [.., length]) => *length == 3,
            _ => false,
        };
        if fits { Ok(goals) } else { Err(wrong_shape(name, &goals.numbers.shape, expected)) }
    }

    /// The number of axes of one target.
    pub fn axes(&self) -> usize {
        if matches!(self.kind, Kind::Position) { 1 } else { 2 }
    }

    /// Each target, after broadcasting along these axes.
    ///
    /// # Errors
    /// `ValueError` for an invalid pose or rotation matrix, with its index.
    pub fn each(&self, leading: &[usize]) -> PyResult<Vec<Goal>> {
        let numbers = self.numbers.slice::<f64>()?;
        let refused = |index: usize, why: String| {
            let place = if leading.is_empty() { String::new() } else { format!("[{}]", place(index, leading)) };
            PyValueError::new_err(format!("{}{place}: {why}", self.numbers.name))
        };
        let one = |(index, x): (usize, &[f64])| -> PyResult<Goal> {
            let row3 = |k: usize| std::array::from_fn(|column| x[3 * k + column]);
            let row4 = |k: usize| std::array::from_fn(|column| x[4 * k + column]);
            match self.kind {
                Kind::Position => match row3(0) {
                    p if p.iter().all(|x: &f64| x.is_finite()) => Ok(Goal::Position(Vec3(p))),
                    [x, y, z] => Err(refused(index, format!("({x}, {y}, {z}), expected finite numbers, m"))),
                },
                Kind::Pose => pose(std::array::from_fn(row4))
                    .map(Goal::Pose)
                    .map_err(|error| refused(index, Python::attach(|py| error.value(py).to_string()))),
                Kind::Orientation => SO3::from_rounded_matrix(Mat3::from_rows(std::array::from_fn(row3)))
                    .map(Goal::Orientation)
                    .map_err(|error| refused(index, error.to_string())),
            }
        };
        let length = match self.kind {
            Kind::Pose => 16,
            Kind::Position => 3,
            Kind::Orientation => 9,
        };
        numbers.chunks_exact(length).enumerate().map(one).collect()
    }
}
