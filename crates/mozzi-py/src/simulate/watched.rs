//! Events of a simulation, as Python functions or as conditions in words, and their results.

use crate::failure::of_model;
use crate::model::array;
use crate::results::named;
use mozzi::Model;
use mozzi_sim::{Direction, Event, Occurrence, Stopped};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::cell::RefCell;

/// `until` and `events`: each a condition, a function, or a list of them.
pub struct Watched<'a, 'py> {
    pub until: Option<&'a Bound<'py, PyAny>>,
    pub events: Option<&'a Bound<'py, PyAny>>,
}

impl<'py> Watched<'_, 'py> {
    pub fn is_empty(&self) -> bool {
        self.until.is_none() && self.events.is_none()
    }

    /// An exception raised by a function is kept.
    pub fn events<'e>(
        &self,
        model: &'e Model,
        start: [&[f64]; 2],
        raised: &'e RefCell<Option<PyErr>>,
    ) -> PyResult<Vec<Event<'e>>>
    where
        'py: 'e,
    {
        let mut events = Vec::new();
        for (name, given, stop) in [("until", self.until, true), ("events", self.events, false)] {
            let Some(given) = given else { continue };
            let one = given.is_callable() || given.is_instance_of::<PyString>();
            let list = if one { vec![given.clone()] } else { given.try_iter()?.collect::<PyResult<_>>()? };
            for each in list {
                let these = event(name, each, model, start, raised)?;
                events.extend(these.into_iter().map(|event| Event { stop, ..event }));
            }
        }
        Ok(events)
    }
}

fn event<'e, 'py: 'e>(
    name: &str,
    given: Bound<'py, PyAny>,
    model: &'e Model,
    start: [&[f64]; 2],
    raised: &'e RefCell<Option<PyErr>>,
) -> PyResult<Vec<Event<'e>>> {
    if given.is_instance_of::<PyString>() {
        return Event::condition(model, &given.extract::<String>()?).map_err(of_model);
    }
    if !given.is_callable() {
        let found = given.get_type().name()?;
        let expected = "a function of (t, theta, dtheta), a condition such as 'elbow > 1.2', or a list of them";
        return Err(PyTypeError::new_err(format!("{name} has an entry of type {found}, expected {expected}")));
    }
    let called = given.getattr("__name__").and_then(|name| name.extract::<String>()).unwrap_or_else(|_| name.into());
    let word = name.to_string();
    let answer = move |t: f64, [theta, dtheta]: [&[f64]; 2]| -> PyResult<(f64, bool)> {
        let list = |x: &[f64]| array(given.py(), &[x.len()], x.iter().copied());
        let answer = given.call1((t, list(theta)?, list(dtheta)?))?;
        if let Ok(holds) = answer.extract::<bool>() {
            return Ok((if holds { 1.0 } else { -1.0 }, true));
        }
        match answer.extract::<f64>() {
            Ok(number) if number.is_nan() => Err(PyValueError::new_err(format!(
                "the function of {word} answered nan at t = {t} s, expected a number or a bool"
            ))),
            Ok(number) => Ok((number, false)),
            Err(_) => Err(PyTypeError::new_err(format!(
                "the function of {word} answered {answer}, expected a number or a bool"
            ))),
        }
    };
    // a bool counts where it becomes true
    let (at_start, is_bool) = answer(0.0, start)?;
    if is_bool && at_start > 0.0 {
        let when = "it counts when it becomes True";
        return Err(PyValueError::new_err(format!(
            "the function of {name} is True at the start, expected False: {when}"
        )));
    }
    let direction = if is_bool { Direction::Rising } else { Direction::Any };
    let function = move |t: f64, theta: &[f64], dtheta: &[f64]| {
        answer(t, [theta, dtheta]).map(|(value, _)| value).unwrap_or_else(|error| {
            raised.borrow_mut().get_or_insert(error);
            f64::NAN
        })
    };
    Ok(vec![Event { direction, ..Event::new(called, function) }])
}

/// A list of `Occurrence`s.
pub fn happened<'py>(py: Python<'py>, events: Vec<Occurrence>) -> PyResult<Bound<'py, PyAny>> {
    let each = |event: Occurrence| {
        let list = |x: Vec<f64>| array(py, &[x.len()], x);
        let fields = vec![
            event.name.into_pyobject(py)?.into_any(),
            event.t.into_pyobject(py)?.into_any(),
            list(event.theta)?,
            list(event.dtheta)?,
            event.stop.into_pyobject(py)?.to_owned().into_any(),
        ];
        named(py, "Occurrence", fields)
    };
    let all = events.into_iter().map(each).collect::<PyResult<Vec<_>>>()?;
    all.into_pyobject(py)
}

/// A list of `LimitReached`.
pub fn stopped<'py>(py: Python<'py>, stops: Vec<Stopped>) -> PyResult<Bound<'py, PyAny>> {
    let each = |stop: Stopped| {
        let fields = vec![
            stop.joint.into_pyobject(py)?.into_any(),
            stop.limit.into_pyobject(py)?.into_any(),
            stop.first.into_pyobject(py)?.into_any(),
            stop.beyond.into_pyobject(py)?.into_any(),
            stop.times.into_pyobject(py)?.into_any(),
        ];
        named(py, "LimitReached", fields)
    };
    let all = stops.into_iter().map(each).collect::<PyResult<Vec<_>>>()?;
    all.into_pyobject(py)
}
