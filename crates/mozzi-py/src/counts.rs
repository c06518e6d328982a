//! Whole numbers among the arguments: steps, rows, iterations.

use mozzi::Model;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// More steps, or a motion of more bytes, are refused, as by `mozzi simulate`.
const STEPS: f64 = 1e9;
const BYTES: f64 = 16e9;

/// A number that is not negative.
pub fn count(name: &str, given: i64) -> PyResult<usize> {
    usize::try_from(given).map_err(|_| PyValueError::new_err(format!("{name} is {given}, expected at least 1")))
}

/// The number of steps; by default those of a millisecond, as in `mozzi simulate`. A wrong duration is refused later.
pub fn steps(given: Option<&Bound<'_, PyAny>>, duration: f64) -> PyResult<usize> {
    let Some(given) = given else { return Ok((1e3 * duration).ceil().max(1.0) as usize) };
    match given.extract::<i64>() {
        Ok(steps) => count("steps", steps),
        Err(error) if error.is_instance_of::<PyTypeError>(given.py()) => {
            let found = given.str()?;
            let expected = "expected an int, the number of steps; a time step dt is steps=round(duration / dt)";
            Err(PyTypeError::new_err(format!("steps is {found}, {expected}")))
        }
        Err(_) => Err(PyValueError::new_err(format!("steps is {}, expected at most {STEPS:e}", given.str()?))),
    }
}

/// Refuses a simulation of too many steps, or of too many rows for the memory.
pub fn check_size(model: &Model, motions: usize, steps: usize, record_every: usize) -> PyResult<()> {
    if steps as f64 > STEPS {
        return Err(PyValueError::new_err(format!("steps is {steps}, expected at most {STEPS:e}")));
    }
    let rows = (steps / record_every.max(1)) as f64 + 1.0;
    let numbers = (model.nq() + 3 * model.n() + 3) as f64;
    let bytes = 8.0 * numbers * rows * motions as f64;
    if bytes > BYTES {
        let found = format!("the motion takes {:.0} GB of memory ({rows} rows)", bytes / 1e9);
        return Err(PyValueError::new_err(format!("{found}, expected at most 16 GB; record_every records fewer rows")));
    }
    Ok(())
}
