//! Kernels on a GPU for `mozzi._gpu`, which gives the addresses of arrays.

use crate::model::PyModel;
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Binary, Device, Error, Form, Kernel, Nvrtc, Rollout, RolloutArrays, Source, Steps, Stream};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A quantity's kernel on a device.
#[pyclass(frozen, module = "mozzi._mozzi")]
pub struct GpuKernel {
    kernel: Kernel,
    outputs: Vec<(&'static str, Vec<usize>)>,
}

fn failure(error: Error) -> PyErr {
    match error {
        Error::Model(error) => crate::failure::of_model(error),
        error @ (Error::Unsupported { .. } | Error::WrongCount { .. }) => PyValueError::new_err(error.to_string()),
        error => PyRuntimeError::new_err(error.to_string()),
    }
}

fn choice<T: Copy>(what: &str, found: &str, known: [(&str, T); 2]) -> PyResult<T> {
    let [(first, _), (second, _)] = known;
    let chosen = known.iter().find(|(name, _)| *name == found).map(|(_, value)| *value);
    chosen.ok_or_else(|| PyValueError::new_err(format!("{what} is '{found}', expected '{first}' or '{second}'")))
}

fn precision(dtype: &str) -> PyResult<Precision> {
    choice("dtype", dtype, [("float32", Precision::F32), ("float64", Precision::F64)])
}

fn layout(layout: &str) -> PyResult<CudaLayout> {
    choice("layout", layout, [("rows", CudaLayout::Rows), ("columns", CudaLayout::Columns)])
}

/// A quantity's kernel on a device, by NVRTC as of [`compiled`].
pub fn loaded(
    robot: &Model,
    query: Query<'_>,
    form: Form,
    device: &Device,
    packages: &[PathBuf],
) -> Result<Kernel, Error> {
    let source = Source::new(robot, query, form)?;
    device.load(&source, &*compiled(&source, device, packages)?)
}

/// By NVRTC of `MOZZI_NVRTC`, else of Python's packages, else of the system.
fn compiled(source: &Source, device: &Device, packages: &[PathBuf]) -> Result<Arc<Binary>, Error> {
    let from_variable = std::env::var_os("MOZZI_NVRTC").is_some();
    let of_packages = if from_variable { None } else { Nvrtc::in_packages(packages).ok() };
    source.compile(&of_packages.map_or_else(Nvrtc::find, Ok)?, device.arch())
}

#[pymethods]
impl GpuKernel {
    /// `packages`: folders in which NVRTC's wheel may be.
    #[new]
    #[allow(clippy::too_many_arguments)] // called by `mozzi._gpu` alone
    #[pyo3(signature = (model, quantity, frame, dtype, layout, packed, device, packages))]
    fn new(
        model: &PyModel,
        quantity: &str,
        frame: Option<&str>,
        dtype: &str,
        layout: &str,
        packed: bool,
        device: usize,
        packages: Vec<PathBuf>,
    ) -> PyResult<Self> {
        let query = model.query(quantity, frame)?;
        let form = Form { precision: precision(dtype)?, layout: self::layout(layout)?, is_packed: packed };
        let (device, robot) = (Device::open(device).map_err(failure)?, &model.robot().model);
        let kernel = loaded(robot, query, form, &device, &packages).map_err(failure)?;
        let shapes = query.declaration().outputs.iter().zip(query.shapes(robot)).zip(kernel.source().outputs());
        // a packed matrix has no shape but its length
        let shape =
            |shape: Vec<usize>, length| if shape.iter().product::<usize>() == length { shape } else { vec![length] };
        let outputs = shapes.map(|((output, all), found)| (output.name, shape(all, found.length))).collect();
        Ok(GpuKernel { kernel, outputs })
    }

    /// Names and lengths of the inputs.
    #[getter]
    fn inputs(&self) -> Vec<(String, usize)> {
        self.kernel.source().inputs().iter().map(|input| (input.name.clone(), input.length)).collect()
    }

    /// Names and shapes of the outputs.
    #[getter]
    fn outputs(&self) -> Vec<(&'static str, Vec<usize>)> {
        self.outputs.clone()
    }

    /// Launches the kernel on arrays at these addresses, whose lengths `mozzi._gpu` has checked.
    fn launch(&self, inputs: Vec<u64>, outputs: Vec<u64>, states: usize, stream: usize) -> PyResult<()> {
        // SAFETY: addresses and shapes are those of arrays that Python's frameworks own on this device, checked by
        // `mozzi._gpu`, which also hands over the stream on which they are used
        unsafe { self.kernel.launch(&inputs, &outputs, states, Stream(stream)) }.map_err(failure)
    }
}

/// Steps of many robots on a device.
#[pyclass(frozen, module = "mozzi._mozzi")]
pub struct GpuRollout(Rollout);

#[pymethods]
impl GpuRollout {
    #[new]
    fn new(model: &PyModel, dtype: &str, layout: &str, device: usize, packages: Vec<PathBuf>) -> PyResult<Self> {
        let (device, robot) = (Device::open(device).map_err(failure)?, &model.robot().model);
        let source = Source::rollout(robot, precision(dtype)?, self::layout(layout)?).map_err(failure)?;
        let binary = compiled(&source, &device, &packages).map_err(failure)?;
        Rollout::load(&device, &source, &binary).map(GpuRollout).map_err(failure)
    }

    /// Launches the steps on arrays at these addresses, whose lengths `mozzi._gpu` has checked.
    ///
    /// They are θ and θ̇; τ or none; gains and desired states or none; the tables of θ and θ̇.
    #[allow(clippy::too_many_arguments)] // called by `mozzi._gpu` alone
    fn launch(
        &self,
        state: [u64; 2],
        tau: Option<u64>,
        feedback: Option<[u64; 2]>,
        tables: [u64; 2],
        step: f64,
        steps: usize,
        every: usize,
        robots: usize,
        stream: usize,
    ) -> PyResult<()> {
        let ([theta, dtheta], [theta_table, dtheta_table]) = (state, tables);
        let arrays = RolloutArrays { theta, dtheta, tau, feedback, theta_table, dtheta_table };
        let steps = Steps { step, steps, every };
        // SAFETY: as of `GpuKernel::launch`
        unsafe { self.0.launch(&arrays, &steps, robots, Stream(stream)) }.map_err(failure)
    }
}

#[pymethods]
impl PyModel {
    /// Return the robot on an NVIDIA GPU, whose methods compute quantities of arrays in the GPU's memory.
    ///
    /// Parameters
    /// ----------
    /// layout : {'rows', 'columns'}
    ///     'rows': arrays (..., n), as everywhere in mozzi. 'columns': arrays (n, N), which need
    ///     fewer instructions.
    /// device : int
    ///     Number of the device.
    ///
    /// Returns
    /// -------
    /// Gpu
    ///     Its methods are the quantities: see docs/gpu-guide.md.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     No CUDA device was found, or no NVRTC (``pip install nvidia-cuda-nvrtc``).
    #[pyo3(signature = (*, layout="rows", device=0))]
    fn to_gpu<'py>(slf: Bound<'py, Self>, layout: &str, device: usize) -> PyResult<Bound<'py, PyAny>> {
        self::layout(layout)?;
        Device::open(device).map_err(failure)?;
        let py = slf.py();
        py.import("mozzi._gpu")?.getattr("Gpu")?.call1((slf, layout, device))
    }
}
