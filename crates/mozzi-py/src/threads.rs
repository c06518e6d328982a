//! `threads=`.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// More would only wait for each other.
const MOST: i64 = 1024;

/// How many threads share the states.
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
