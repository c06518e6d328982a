//! One method for all quantities: from its arguments to the query, its environment and its options.

use crate::arguments::Arguments;
use crate::array::Numbers;
use crate::failure::of_model;
use crate::model::PyModel;
use crate::robot::Robot;
use crate::signature::{Signature, Slot};
use mozzi::quantities::{LIST, Of, Query};
use mozzi::{FrameId, TaskFrame, Vec3};
use pyo3::exceptions::{PyException, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString, PyTuple};
use std::sync::LazyLock;

static SIGNATURES: LazyLock<Vec<Signature>> = LazyLock::new(|| LIST.iter().map(Signature::new).collect());

/// The quantity at this index of the list, for positional and keyword arguments.
#[inline]
pub fn call<'py>(
    index: usize,
    model: &Bound<'py, PyAny>,
    positional: &[Borrowed<'_, 'py, PyAny>],
    names: Option<Borrowed<'_, 'py, PyTuple>>,
    named: &[Borrowed<'_, 'py, PyAny>],
) -> PyResult<Bound<'py, PyAny>> {
    let robot = model.cast::<PyModel>()?.get().robot();
    let parts;
    let mut given = Arguments::default();
    given.fill(&SIGNATURES[index], positional, names, named)?;
    if let Some(environment) = given.get(Slot::Environment) {
        parts = given.parts_of(environment, &SIGNATURES[index])?;
        given.extend(&parts);
    }
    let mut rows = None;
    let query = of_subject(Query::at(index), robot, &given, &mut rows)?;
    let threads = given.get(Slot::Threads).map(|threads| threads.extract()).transpose()?;
    if let Some(found) = robot.at_one_state(model.py(), &query, &given)? {
        return Ok(found);
    }
    robot.compute(model.py(), &query, &given, threads)
}

/// The query of the frame, the task or the point that was given; its rows are kept in `rows`.
#[inline]
pub fn of_subject<'q>(
    mut query: Query<'q>,
    robot: &Robot,
    given: &Arguments,
    rows: &'q mut Option<Vec<usize>>,
) -> PyResult<Query<'q>> {
    match query.declaration().of {
        Of::Robot => {}
        Of::Frame => query.subject.frame = Some(frame(robot, given)?),
        Of::Task => {
            query.subject.frame = Some(frame(robot, given)?);
            query.subject.coordinates = coordinates(text(given, Slot::Coordinates)?)?;
            *rows = given.get(Slot::Rows).map(self::rows).transpose()?;
            query.subject.rows = rows.as_deref().unwrap_or(query.subject.rows);
        }
        Of::Point => {
            if let Some(point) = given.get(Slot::About) {
                query.subject.point = Vec3(Numbers::fixed("about", point, "(3,): a point of {s}, m")?);
            }
        }
    }
    Ok(query)
}

#[inline]
fn frame(robot: &Robot, given: &Arguments) -> PyResult<FrameId> {
    robot.frame(text(given, Slot::Frame)?).map_err(of_model)
}

/// A str, if it was given.
fn text<'a>(given: &'a Arguments, slot: Slot) -> PyResult<Option<&'a str>> {
    let Some(value) = given.get(slot) else { return Ok(None) };
    match value.cast::<PyString>() {
        Ok(text) => text.to_str().map(Some),
        Err(_) => {
            let name = if slot == Slot::Frame { "frame" } else { "coordinates" };
            Err(PyTypeError::new_err(format!("{name} is a {}, expected a str", value.get_type().name()?)))
        }
    }
}

/// Row numbers of a task.
pub fn rows(given: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    let kind = given.get_type().name()?;
    let wrong =
        || PyTypeError::new_err(format!("rows is {given} ({kind}), expected a sequence of row numbers from 0 to 5"));
    // True and False would be rows 1 and 0
    if given.try_iter().is_ok_and(|items| items.flatten().any(|item| item.is_instance_of::<PyBool>())) {
        return Err(wrong());
    }
    given.extract().map_err(|error: PyErr| match error.is_instance_of::<PyException>(given.py()) {
        true => wrong(),
        false => error,
    })
}

/// Coordinates of a task by their name.
pub fn coordinates(name: Option<&str>) -> PyResult<TaskFrame> {
    match name {
        Some("body") | None => Ok(TaskFrame::Body),
        Some("space") => Ok(TaskFrame::Space),
        Some(other) => Err(PyValueError::new_err(format!("coordinates is '{other}', expected 'body' or 'space'"))),
    }
}
