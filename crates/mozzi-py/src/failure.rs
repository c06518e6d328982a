//! Converts errors of Rust to errors of Python with the same message.

use pyo3::PyTypeInfo;
use pyo3::create_exception;
use pyo3::exceptions::{PyArithmeticError, PyOSError, PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::ffi::CString;
use std::path::Path;

create_exception!(
    mozzi,
    LoadError,
    PyValueError,
    "A robot's file is invalid.

`diagnostics` has one line for each finding: errors in the order of the file, then warnings, those that change the
motion first."
);
create_exception!(mozzi, LoadWarning, PyUserWarning, "A robot's file is odd; its values are used as they are.");
create_exception!(
    mozzi,
    DynamicsWarning,
    LoadWarning,
    "An element of a robot's file is ignored or replaced, so that the robot may move differently.

Such an element is a force, a property or an unknown word."
);
create_exception!(
    mozzi,
    SingularError,
    PyArithmeticError,
    "The mass matrix, or a task, is singular at a state; the acceleration or the wrench is undefined."
);
create_exception!(mozzi, DivergedError, PyArithmeticError, "A simulated state became infinite or NaN.");
create_exception!(
    mozzi,
    MotionError,
    PyArithmeticError,
    "No motion was found.

The goal is out of reach, the path breaks or leaves the robot's reach, a motor is too weak, or nothing limits the
speed."
);

/// A warning; `level` 1 points to the caller's line, 2 to the line that called it.
pub fn warn<Category: PyTypeInfo>(py: Python<'_>, text: &str, level: i32) -> PyResult<()> {
    let text = CString::new(text.replace('\0', "\\0")).map_err(|error| PyValueError::new_err(error.to_string()))?;
    PyErr::warn(py, &py.get_type::<Category>(), &text, level)
}

/// An error of the library, or of a simulation.
pub fn of_model(error: impl Into<mozzi_sim::Error>) -> PyErr {
    let error = error.into();
    raised(&error, error.to_string())
}

fn raised(error: &mozzi_sim::Error, text: String) -> PyErr {
    use mozzi::Error as Of;
    match error {
        mozzi_sim::Error::Model(Of::SingularMassMatrix { .. } | Of::SingularTask { .. }) => {
            SingularError::new_err(text)
        }
        mozzi_sim::Error::Diverged { .. } => DivergedError::new_err(text),
        _ => PyValueError::new_err(text),
    }
}

/// An error of a motion.
pub fn of_motion(error: mozzi_motion::Error) -> PyErr {
    match error {
        mozzi_motion::Error::Model(error) => of_model(error),
        mozzi_motion::Error::Simulation(error) => of_model(error),
        other => MotionError::new_err(other.to_string()),
    }
}

/// The error of one of many motions.
pub fn of_one_motion(error: mozzi_motion::Error, index: usize, leading: &[usize]) -> PyErr {
    match error {
        mozzi_motion::Error::Model(error) => of_state(error, index, leading),
        other if leading.is_empty() => of_motion(other),
        other => MotionError::new_err(format!("state [{}]: {other}", place(index, leading))),
    }
}

/// An error of a batch; the error of a state includes its index along the leading axes.
pub fn of_batch(error: mozzi_engine::Error, leading: &[usize]) -> PyErr {
    match error {
        mozzi_engine::Error::State { index, source } => of_state(source, index, leading),
        mozzi_engine::Error::Model(error) => of_model(error),
        mozzi_engine::Error::Simulation(error) => of_model(error),
        error @ mozzi_engine::Error::Threads { .. } => PyRuntimeError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// The error of one of many states.
pub fn of_state(error: impl Into<mozzi_sim::Error>, index: usize, leading: &[usize]) -> PyErr {
    let error = error.into();
    if leading.is_empty() {
        return of_model(error);
    }
    raised(&error, format!("state [{}]: {error}", place(index, leading)))
}

/// The index of a state along the leading axes: `2, 0`.
pub fn place(index: usize, leading: &[usize]) -> String {
    let mut rest = index;
    let mut place: Vec<String> = leading
        .iter()
        .rev()
        .map(|&length| {
            let at = rest % length.max(1);
            rest /= length.max(1);
            at.to_string()
        })
        .collect();
    place.reverse();
    place.join(", ")
}

/// An error of the system with a file: the subclass of OSError for its number, with the file's path.
pub fn of_file(path: &Path, error: &std::io::Error) -> PyErr {
    let text = error.to_string();
    match error.raw_os_error() {
        Some(number) => {
            let words = text.split(" (os error").next().unwrap_or_default().to_string();
            PyOSError::new_err((number, words, path.to_string_lossy().into_owned()))
        }
        None => PyOSError::new_err(format!("{}: {text}", path.display())),
    }
}

/// An error of the loader, with its lines as `diagnostics`.
pub fn of_loader(py: Python<'_>, error: mozzi_urdf::LoadError) -> PyErr {
    let text = error.to_string();
    match error {
        mozzi_urdf::LoadError::File { path, source } => match source.raw_os_error() {
            Some(_) => of_file(&path, &source),
            None => PyOSError::new_err(text),
        },
        mozzi_urdf::LoadError::Refused { diagnostics, .. } => {
            let error = LoadError::new_err(text);
            let said = diagnostics.iter().filter(|found| found.consequence() != mozzi_urdf::Consequence::Unused);
            let lines: Vec<String> = said.map(ToString::to_string).collect();
            match error.value(py).setattr("diagnostics", lines) {
                Ok(()) => error,
                Err(other) => other,
            }
        }
        _ => PyValueError::new_err(text),
    }
}
