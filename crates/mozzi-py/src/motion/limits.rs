//! Limits of velocity, acceleration and torque, from Python's arguments.

use crate::arguments::Given;
use crate::array::{Numbers, list};
use mozzi::Model;
use mozzi_motion::trajectories::Limits;
use pyo3::prelude::*;

/// The robot's own limits, each replaced by the given one.
///
/// # Errors
/// `TypeError`, `ValueError` for another shape.
pub fn limits<'py>(
    model: &Model,
    velocity: Given<'_, 'py>,
    acceleration: Given<'_, 'py>,
    torque: Given<'_, 'py>,
) -> PyResult<Limits> {
    let mut limits = Limits::of(model);
    for (name, place, given) in [
        ("velocity", &mut limits.velocity, velocity),
        ("acceleration", &mut limits.acceleration, acceleration),
        ("torque", &mut limits.torque, torque),
    ] {
        if let Some(given) = given {
            *place = one_or_each(name, given, model.n())?;
        }
    }
    Ok(limits)
}

/// n numbers, or one for all.
///
/// # Errors
/// `TypeError`, `ValueError` for another shape.
pub fn one_or_each(name: &'static str, given: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<f64>> {
    let numbers = Numbers::new(name, given)?;
    match numbers.shape[..] {
        [] => Ok(vec![list(name, given, &[])?[0]; n]),
        _ => list(name, given, &[n]),
    }
}
