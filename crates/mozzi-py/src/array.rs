//! Converts Python's arguments to numbers in C order, and names shapes that do not match.

use crate::numpy::{self, Element, Fresh};
use mozzi::nalgebra::DMatrix;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyFloat, PyInt, PyList};

/// An argument as a contiguous array of float64 or float32.
pub struct Numbers<'py> {
    pub name: &'static str,
    pub array: Bound<'py, PyAny>,
    pub shape: Vec<usize>,
    pub is_single: bool,
}

/// A function of NumPy.
pub fn function<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    static NUMPY: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    NUMPY.get_or_try_init(py, || py.import("numpy").map(Bound::unbind))?.bind(py).getattr(name)
}

impl<'py> Numbers<'py> {
    /// Takes arrays as they are, and lets NumPy convert all other objects.
    ///
    /// # Errors
    /// `TypeError` for an object that does not consist of real numbers.
    pub fn new(name: &'static str, given: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Some((shape, _)) = numpy::view::<f64>(given) {
            return Ok(Numbers { name, array: given.clone(), shape: shape.to_vec(), is_single: false });
        }
        if let Some((shape, _)) = numpy::view::<f32>(given) {
            return Ok(Numbers { name, array: given.clone(), shape: shape.to_vec(), is_single: true });
        }
        let py = given.py();
        if let Some(array) = plain(given)? {
            let shape = vec![array.len()];
            return Ok(Numbers { name, array: array.into_array(), shape, is_single: false });
        }
        let refused = |why: String, cause: Option<PyErr>| {
            let error = PyTypeError::new_err(why);
            error.set_cause(py, cause);
            error
        };
        let no_array = |cause: PyErr| {
            let kind = given.get_type().name().map_or_else(|_| "object".to_string(), |name| name.to_string());
            let why = format!("{name} is a {kind}, expected an array of numbers: {}", cause.value(py));
            if cause.is_instance_of::<pyo3::exceptions::PyException>(py) { refused(why, Some(cause)) } else { cause }
        };
        let array = function(py, "asarray")?.call1((given,)).map_err(no_array)?;
        let dtype = array.getattr("dtype")?;
        let (kind, size): (char, usize) = (dtype.getattr("kind")?.extract()?, dtype.getattr("itemsize")?.extract()?);
        let is_single = kind == 'f' && size == 4;
        if !matches!(kind, 'f' | 'i' | 'u' | 'b' | 'O') {
            return Err(refused(format!("{name} has dtype {dtype}, expected real numbers"), None));
        }
        let count =
            |condition: Bound<'py, PyAny>| function(py, "count_nonzero")?.call1((condition,))?.extract::<usize>();
        if kind == 'O' && array.call_method1("ravel", ())?.call_method0("tolist")?.contains(py.None())? {
            return Err(refused(format!("{name} holds None, expected real numbers"), None)); // NumPy would give NaN
        }
        if given.hasattr("mask")? && given.hasattr("filled")? && count(given.getattr("mask")?)? > 0 {
            return Err(refused(format!("{name} has masked entries, expected real numbers"), None));
        }
        let wanted = if is_single { f32::NAME } else { f64::NAME };
        let array = function(py, "array")?
            .call((array,), Some(&[("dtype", wanted), ("order", "C")].into_py_dict(py)?))
            .map_err(no_array)?;
        let shape = array.getattr("shape")?.extract()?;
        Ok(Numbers { name, array, shape, is_single })
    }

    /// The axes before the last `tail`.
    pub fn leading(&self, tail: usize) -> &[usize] {
        &self.shape[..self.shape.len() - tail]
    }

    /// Converts to this number type and broadcasts to these leading axes.
    pub fn spread<T: Element>(&mut self, leading: &[usize], tail: usize) -> PyResult<()> {
        let py = self.array.py();
        if !are_same(self.leading(tail), leading) {
            let shape = [leading, &self.shape[self.shape.len() - tail..]].concat();
            self.array = function(py, "broadcast_to")?.call1((&self.array, shape.clone()))?;
            self.shape = shape;
        }
        if numpy::view::<T>(&self.array).is_none() {
            let options = [("dtype", T::NAME), ("order", "C")].into_py_dict(py)?;
            self.array = function(py, "array")?.call((&self.array,), Some(&options))?;
        }
        Ok(())
    }

    /// The numbers, after [`spread`](Self::spread).
    pub fn slice<T: Element>(&self) -> PyResult<&[T]> {
        let (_, numbers) = numpy::view::<T>(&self.array)
            .ok_or_else(|| PyTypeError::new_err(format!("{}: NumPy made no plain array of it", self.name)))?;
        Ok(numbers)
    }

    /// Exactly this many numbers in a row.
    ///
    /// # Errors
    /// `TypeError`, `ValueError`.
    pub fn fixed<const K: usize>(
        name: &'static str,
        given: &Bound<'py, PyAny>,
        expected: &'static str,
    ) -> PyResult<[f64; K]> {
        let numbers = Numbers::new(name, given)?;
        match numbers.shape[..] == [K] {
            true => numbers.few(),
            false => Err(wrong_shape(name, &numbers.shape, expected)),
        }
    }

    /// The numbers as an array whose length was already checked.
    pub fn few<const K: usize>(mut self) -> PyResult<[f64; K]> {
        self.spread::<f64>(&[], 1)?;
        let mut few = [0.0; K];
        few.copy_from_slice(self.slice()?);
        Ok(few)
    }

    /// A matrix of R rows and C columns.
    ///
    /// # Errors
    /// `TypeError`, `ValueError`.
    pub fn matrix<const R: usize, const C: usize>(
        name: &'static str,
        given: &Bound<'py, PyAny>,
        expected: &'static str,
    ) -> PyResult<[[f64; C]; R]> {
        let mut numbers = Numbers::new(name, given)?;
        if numbers.shape != [R, C] {
            return Err(wrong_shape(name, &numbers.shape, expected));
        }
        numbers.spread::<f64>(&[], 2)?;
        let slice = numbers.slice::<f64>()?;
        Ok(std::array::from_fn(|row| std::array::from_fn(|column| slice[row * C + column])))
    }
}

/// A list of Python's own numbers, converted without NumPy.
fn plain<'py>(given: &Bound<'py, PyAny>) -> PyResult<Option<Fresh<'py, f64>>> {
    let Ok(list) = given.cast_exact::<PyList>() else { return Ok(None) };
    let mut fresh = Fresh::<f64>::new(given.py(), &[list.len()])?;
    for (place, item) in fresh.numbers().iter_mut().zip(list) {
        if !(item.is_exact_instance_of::<PyFloat>() || item.is_exact_instance_of::<PyInt>()) {
            return Ok(None);
        }
        let Ok(x) = item.extract() else { return Ok(None) }; // an int beyond float64: NumPy reports it
        *place = x;
    }
    Ok((!list.is_empty()).then_some(fresh))
}

/// Converts a matrix from column-major to row-major order.
pub fn by_rows(M: &DMatrix<f64>, out: &mut [f64]) {
    let columns = M.ncols();
    out.iter_mut().enumerate().for_each(|(k, x)| *x = M[(k / columns, k % columns)]);
}

/// The numbers of an argument of this shape.
///
/// # Errors
/// `TypeError`, `ValueError` if the argument is not numeric or has another shape.
pub fn list(name: &'static str, given: &Bound<'_, PyAny>, shape: &[usize]) -> PyResult<Vec<f64>> {
    let mut numbers = Numbers::new(name, given)?;
    if numbers.shape != shape {
        return Err(wrong_shape(name, &numbers.shape, shown(shape)));
    }
    numbers.spread::<f64>(&[], shape.len())?;
    Ok(numbers.slice::<f64>()?.to_vec())
}

/// `theta has shape (6,), expected (..., 7): …`
pub fn wrong_shape(name: &str, found: &[usize], expected: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("{name} has shape {}, expected {expected}", shown(found)))
}

/// A shape as Python writes it.
pub fn shown(shape: &[usize]) -> String {
    match shape {
        [only] => format!("({only},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Usually both are empty: `==` would call `memcmp`, which takes a hundred nanoseconds for zero bytes at a dangling
/// address.
fn are_same(a: &[usize], b: &[usize]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b)
}

/// NumPy's broadcasting rule: axes are aligned at the last, and a length of 1 is repeated.
///
/// # Errors
/// `ValueError` that names both shapes.
pub fn common_leading<'a>(shapes: impl IntoIterator<Item = (&'static str, &'a [usize])>) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for (name, shape) in shapes {
        if common.is_empty() {
            common.extend(shape);
        }
        if are_same(&common, shape) {
            continue;
        }
        let rank = common.len().max(shape.len());
        let before = common.clone();
        common.splice(..0, std::iter::repeat_n(1, rank - before.len()));
        let offset = rank - shape.len();
        for (k, &length) in shape.iter().enumerate() {
            let at = &mut common[offset + k];
            match (*at, length) {
                (a, b) if a == b || b == 1 => {}
                (1, b) => *at = b,
                _ => {
                    let found = shown(shape);
                    let why = format!(
                        "{name} has leading axes {found}, which do not go with {} of the arguments before it",
                        shown(&before)
                    );
                    return Err(PyValueError::new_err(why));
                }
            }
        }
    }
    Ok(common)
}
