//! Functions of one number, such as a time, at one value or at many: the results as arrays, whose leading axes are
//! those of the values.

use crate::array::{Numbers, shown};
use crate::failure::place;
use crate::model::array;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::ops::RangeInclusive;

/// Numbers of any shape.
pub struct Instants {
    leading: Vec<usize>,
    numbers: Vec<f64>,
}

impl Instants {
    /// Any numbers, including infinite ones and NaN.
    ///
    /// # Errors
    /// `TypeError`.
    pub fn any(name: &'static str, given: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut numbers = Numbers::new(name, given)?;
        let leading = numbers.shape.clone();
        numbers.spread::<f64>(&leading, 0)?;
        Ok(Instants { leading, numbers: numbers.slice::<f64>()?.to_vec() })
    }

    /// Finite numbers within this range.
    ///
    /// # Errors
    /// `TypeError`, `ValueError` with the index of the number.
    pub fn new(name: &'static str, given: &Bound<'_, PyAny>, range: RangeInclusive<f64>, unit: &str) -> PyResult<Self> {
        let found = Self::any(name, given)?;
        let is_wrong = |x: &f64| !x.is_finite() || !range.contains(x);
        let Some(index) = found.numbers.iter().position(is_wrong) else { return Ok(found) };
        let place =
            if found.leading.is_empty() { String::new() } else { format!("[{}]", place(index, &found.leading)) };
        Err(PyValueError::new_err(format!("{name}{place} is {}, expected {unit}", found.numbers[index])))
    }

    /// Times in seconds.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn seconds(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::new("t", given, f64::MIN..=f64::MAX, "finite numbers of seconds")
    }

    /// f at each number: K lists of these lengths, as K arrays of shape (..., length).
    pub fn rows<'py, const K: usize>(
        &self,
        py: Python<'py>,
        lengths: [usize; K],
        f: impl Fn(f64) -> [Vec<f64>; K],
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let mut columns: [Vec<f64>; K] = lengths.map(|length| Vec::with_capacity(length * self.numbers.len()));
        for &x in &self.numbers {
            for ((column, list), length) in columns.iter_mut().zip(f(x)).zip(lengths) {
                if list.len() != length {
                    let (found, expected) = (shown(&[list.len()]), shown(&[length]));
                    return Err(PyValueError::new_err(format!("a list has shape {found}, expected {expected}")));
                }
                column.extend(list);
            }
        }
        columns
            .into_iter()
            .zip(lengths)
            .map(|(column, length)| array(py, &[&self.leading[..], &[length]].concat(), column))
            .collect()
    }

    /// f at each number: K numbers, as K floats or arrays of shape (...).
    pub fn numbers<'py, const K: usize>(
        &self,
        py: Python<'py>,
        f: impl Fn(f64) -> [f64; K],
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let found: Vec<[f64; K]> = self.numbers.iter().map(|&x| f(x)).collect();
        let column = |k: usize| {
            let numbers = array(py, &self.leading, found.iter().map(|all| all[k]))?;
            if self.leading.is_empty() { numbers.call_method0("item") } else { Ok(numbers) }
        };
        (0..K).map(column).collect()
    }

    /// f at each number: poses, as an array of shape (..., 4, 4).
    pub fn poses<'py>(&self, py: Python<'py>, f: impl Fn(f64) -> mozzi::SE3) -> PyResult<Bound<'py, PyAny>> {
        let entries = self.numbers.iter().flat_map(|&x| f(x).to_matrix().into_iter().flatten());
        array(py, &[&self.leading[..], &[4, 4]].concat(), entries)
    }
}
