//! Solutions of inverse kinematics, for one target or for many, as Python's named tuple.

use crate::array::function;
use crate::failure::{MotionError, place};
use crate::model::array;
use crate::results::named;
use mozzi_motion::Error;
use mozzi_motion::inverse_kinematics::{Residual, Solution};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyList};

/// One target's positions: a solution, or the best positions found.
pub struct Found {
    theta: Vec<f64>,
    residual: Residual,
    starts: usize,
    iterations: usize,
    /// Why the target was not reached; empty if it was.
    reason: String,
}

impl Found {
    pub fn is_reached(&self) -> bool {
        self.reason.is_empty()
    }

    /// Returns an error for a target that was not reached although `must_reach` is set.
    pub fn not_reached(&self, index: usize, leading: &[usize]) -> PyErr {
        let place = if leading.is_empty() { String::new() } else { format!("target [{}]: ", place(index, leading)) };
        MotionError::new_err(format!("{place}{}", self.reason))
    }

    /// A target that is not reached is a result, not an error.
    ///
    /// # Errors
    /// All other errors.
    pub fn of(found: Result<Solution, Error>) -> Result<Self, Error> {
        match found {
            Ok(Solution { theta, residual, starts, iterations }) => {
                Ok(Found { theta, residual, starts, iterations, reason: String::new() })
            }
            Err(error) => {
                let reason = error.to_string();
                match error {
                    Error::NotReached { theta, residual, starts, iterations, .. } => {
                        Ok(Found { theta, residual, starts, iterations, reason })
                    }
                    other => Err(other),
                }
            }
        }
    }
}

/// `mozzi.Solution`: numbers and strings for one target, arrays for many.
pub fn solution<'py>(py: Python<'py>, all: &[Found], leading: &[usize], nq: usize) -> PyResult<Bound<'py, PyAny>> {
    let column = |part: &dyn Fn(&Found) -> f64, dtype: &str| -> PyResult<Bound<'py, PyAny>> {
        let numbers = array(py, leading, all.iter().map(part))?.call_method1("astype", (dtype,))?;
        if leading.is_empty() { numbers.call_method0("item") } else { Ok(numbers) }
    };
    // all solutions have one kind of goal
    let residual = |part: fn(&Residual) -> Option<f64>| -> PyResult<Bound<'py, PyAny>> {
        if all.iter().any(|found| part(&found.residual).is_none()) {
            return Ok(py.None().into_bound(py));
        }
        column(&|found: &Found| part(&found.residual).unwrap_or_default(), "float64")
    };
    let reason = match all {
        [found] if leading.is_empty() => found.reason.as_str().into_bound_py_any(py)?,
        _ => {
            let words = PyList::new(py, all.iter().map(|found| &found.reason))?;
            let words = function(py, "array")?.call((words,), Some(&[("dtype", "object")].into_py_dict(py)?))?;
            words.call_method1("reshape", (leading,))?
        }
    };
    let fields = vec![
        array(py, &[leading, &[nq]].concat(), all.iter().flat_map(|found| found.theta.iter().copied()))?,
        column(&|found: &Found| f64::from(u8::from(found.is_reached())), "bool")?,
        residual(|residual| residual.angle)?,
        residual(|residual| residual.distance)?,
        column(&|found: &Found| found.iterations as f64, "int64")?,
        column(&|found: &Found| found.starts as f64, "int64")?,
        reason,
    ];
    named(py, "Solution", fields)
}
