//! `mozzi.jax`: a handler that XLA calls, and what its Python side needs to know of a quantity.
//!
//! One handler computes every quantity and its derivatives, which its attributes choose: see [`call`] and
//! [`Product`](mozzi_engine::Product).

mod call;
mod gpu;
mod interface;
mod registry;

use crate::failure::of_model;
use crate::model::PyModel;
use mozzi::quantities::{Of, Query};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Names of arrays with their shapes at one state.
type Shapes = Vec<(&'static str, Vec<usize>)>;

#[pymethods]
impl PyModel {
    /// Registers the robot for XLA; the returned number depends only on its content.
    fn _jax_handle(&self) -> PyResult<i64> {
        registry::register(&self.robot().model).map_err(PyValueError::new_err)
    }

    /// Name of the quantity's frame, empty if it has none, and names and shapes of its inputs and outputs.
    fn _jax_shapes(&self, quantity: &str, frame: Option<&str>) -> PyResult<(String, Shapes, Shapes)> {
        let model = &self.robot().model;
        let is_of_frame = Query::named(quantity).map_err(of_model)?.declaration().of == Of::Frame;
        let frame = match is_of_frame {
            true => model.frame_name(self.frame(frame)?).to_string(),
            false => String::new(),
        };
        let query = call::query(model, quantity, &frame).map_err(PyValueError::new_err)?;
        let declaration = query.declaration();
        let inputs = declaration.inputs.iter().zip(query.input_lengths(model));
        let inputs = inputs.map(|(input, length)| (input.name, vec![length])).collect();
        let outputs = declaration.outputs.iter().zip(query.shapes(model));
        Ok((frame, inputs, outputs.map(|(output, shape)| (output.name, shape)).collect()))
    }
}

/// XLA's handler on the CPU, as a capsule.
#[pyfunction]
fn _jax_handler(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    interface::capsule(py, interface::Place::Host)
}

/// XLA's handler on an NVIDIA GPU, as a capsule; `packages` are folders that may contain NVRTC's wheel.
#[pyfunction]
fn _jax_gpu_handler(py: Python<'_>, packages: Vec<PathBuf>) -> PyResult<Bound<'_, PyAny>> {
    gpu::PACKAGES.get_or_init(|| packages);
    interface::capsule(py, interface::Place::Gpu)
}

/// Expressions of XLA's header in C, and their values in this library.
#[pyfunction]
fn _jax_layout(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let layout = PyDict::new(py);
    interface::LAYOUT.iter().try_for_each(|(expression, value)| layout.set_item(expression, value))?;
    Ok(layout)
}

pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(_jax_handler, module)?)?;
    module.add_function(wrap_pyfunction!(_jax_gpu_handler, module)?)?;
    module.add_function(wrap_pyfunction!(_jax_layout, module)?)
}
