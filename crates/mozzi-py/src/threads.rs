//! `threads=`.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The most threads for each core; more would only wait for each other.
const MOST: i64 = 1024;

/// The number of threads among which the states are divided.
#[derive(Clone, Copy, PartialEq)]
pub struct Threads(pub usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let py = given.py();
        let expected = || format!("expected 1 to {MOST}, or None for all cores");
        match given.extract::<i64>() {
            Ok(count @ 1..=MOST) => Ok(Threads(count as usize)),
            Err(error) if error.is_instance_of::<PyTypeError>(py) => {
                Err(PyTypeError::new_err(format!("threads is a {}, {}", given.get_type().name()?, expected())))
            }
            Ok(_) | Err(_) => Err(PyValueError::new_err(format!("threads is {}, {}", given.str()?, expected()))),
        }
    }
}
