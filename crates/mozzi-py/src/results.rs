//! Results: where they are written, and the objects that Python gets: new arrays or the caller's, floats, named tuples.

use crate::arguments::Given;
use crate::array::{function, shown, wrong_shape};
use crate::numpy::{self, Element, Fresh};
use crate::signature::CLASSES;
use mozzi::quantities::Query;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyFloat, PyTuple};

/// Results as a named tuple of `mozzi._results`.
pub fn named<'py>(py: Python<'py>, name: &str, fields: Vec<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
    py.import("mozzi._results")?.getattr(name)?.call1(PyTuple::new(py, fields)?)
}

/// The results of a quantity as its named tuple, of `mozzi._quantities`.
fn several<'py>(py: Python<'py>, query: &Query, fields: Vec<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
    static QUANTITIES: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = QUANTITIES.get_or_try_init(py, || py.import("mozzi._quantities").map(Bound::unbind))?;
    module.bind(py).getattr(CLASSES[query.index()])?.call1(PyTuple::new(py, fields)?)
}

/// The arrays of `out`.
///
/// # Errors
/// `TypeError`, `ValueError` if these are not arrays, or their number differs from the number of results.
pub fn callers_arrays<'py>(query: &Query, out: Given<'_, 'py>) -> PyResult<Option<Vec<Bound<'py, PyAny>>>> {
    let Some(out) = out else { return Ok(None) };
    let outputs = query.declaration().outputs;
    if outputs.len() == 1 {
        return Ok(Some(vec![out.clone()]));
    }
    let expected = || {
        let names: Vec<&str> = outputs.iter().map(|output| output.name).collect();
        format!("expected {} arrays: {}", outputs.len(), names.join(", "))
    };
    let arrays: Vec<Bound<'py, PyAny>> = out.extract().map_err(|_| {
        let kind = out.get_type().name().map_or_else(|_| "object".to_string(), |name| name.to_string());
        PyTypeError::new_err(format!("out is a {kind}, {}", expected()))
    })?;
    if arrays.len() != outputs.len() {
        return Err(PyValueError::new_err(format!("out has {} arrays, {}", arrays.len(), expected())));
    }
    Ok(Some(arrays))
}

/// Where one result is written.
enum Place<'a, 'py, T> {
    New(Fresh<'py, T>),
    Callers(&'a Bound<'py, PyAny>, &'a mut [T]),
    /// Converted by NumPy after it is computed.
    Converted(&'a Bound<'py, PyAny>, Fresh<'py, T>),
}

/// Where the results of a quantity are written.
pub struct Results<'a, 'py, T>(Vec<Place<'a, 'py, T>>);

impl<'a, 'py, T: Element> Results<'a, 'py, T> {
    /// In new arrays of these shapes.
    pub fn new(py: Python<'py>, shapes: &[Vec<usize>]) -> PyResult<Self> {
        shapes.iter().map(|shape| Fresh::new(py, shape).map(Place::New)).collect::<PyResult<_>>().map(Results)
    }

    /// In the caller's arrays, directly if they can be written and share no memory with the inputs or each other.
    ///
    /// # Errors
    /// `TypeError`, `ValueError` if an object is not an array, has another shape, or is given for two outputs.
    pub fn in_arrays(
        query: &Query,
        shapes: &[Vec<usize>],
        arrays: &'a [Bound<'py, PyAny>],
        inputs: &[&Bound<'py, PyAny>],
    ) -> PyResult<Self> {
        let outputs = query.declaration().outputs;
        let name = |k: usize| if outputs.len() == 1 { "out".to_string() } else { format!("out.{}", outputs[k].name) };
        for (k, (array, shape)) in arrays.iter().zip(shapes).enumerate() {
            let name = name(k);
            if !array.is_instance(&function(array.py(), "ndarray")?)? {
                return Err(PyTypeError::new_err(format!("{name} is no array, expected a numpy.ndarray")));
            }
            let found: Vec<usize> = array.getattr("shape")?.extract()?;
            if found != *shape {
                return Err(wrong_shape(&name, &found, shown(shape)));
            }
        }
        for (k, array) in arrays.iter().enumerate() {
            if let Some(first) = arrays[..k].iter().position(|other| other.is(array)) {
                let message = format!("{} and {} are the same array, expected one for each", name(first), name(k));
                return Err(PyValueError::new_err(message));
            }
        }
        // from here on no Python code runs that could move the numbers
        let place = |(k, array): (usize, &'a Bound<'py, PyAny>)| {
            let others = arrays.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, array)| array);
            Ok(match numpy::view_mut::<T>(array, inputs.iter().copied().chain(others)) {
                Some((shape, numbers)) if shape == shapes[k] => Place::Callers(array, numbers),
                _ => Place::Converted(array, Fresh::new(array.py(), &shapes[k])?),
            })
        };
        arrays.iter().enumerate().map(place).collect::<PyResult<_>>().map(Results)
    }

    /// The numbers, to be filled.
    pub fn slices(&mut self) -> Vec<&mut [T]> {
        self.0
            .iter_mut()
            .map(|place| match place {
                Place::New(fresh) | Place::Converted(_, fresh) => fresh.numbers(),
                Place::Callers(_, numbers) => numbers,
            })
            .collect()
    }

    /// The object that Python gets: an array, a float for a new array without axes, or a named tuple.
    pub fn finish(self, py: Python<'py>, query: &Query) -> PyResult<Bound<'py, PyAny>> {
        let finish = |place: Place<'a, 'py, T>| match place {
            Place::New(mut fresh) if fresh.has_no_axes() => {
                Ok(PyFloat::new(py, fresh.numbers()[0].to_f64()).into_any())
            }
            Place::New(fresh) => Ok(fresh.into_array()),
            Place::Callers(array, _) => Ok(array.clone()),
            Place::Converted(array, fresh) => {
                function(py, "copyto")?.call1((array, fresh.into_array()))?;
                Ok(array.clone())
            }
        };
        let mut found = self.0.into_iter().map(finish).collect::<PyResult<Vec<_>>>()?;
        match found.len() {
            1 => Ok(found.swap_remove(0)),
            _ => several(py, query, found),
        }
    }
}
