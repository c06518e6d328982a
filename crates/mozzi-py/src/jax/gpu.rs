//! A call of JAX on an NVIDIA GPU: a quantity's kernel, made at the first call, and checks of lengths.

use super::{call, registry};
use crate::gpu::loaded;
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Argument, Device, Form, Kernel};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Folders in which NVRTC's wheel may be.
pub static PACKAGES: OnceLock<Vec<PathBuf>> = OnceLock::new();

/// Kernels by robot, quantity, frame and whether they are on `f64`. They stay, as the robots do.
type Kernels = BTreeMap<(i64, String, String, bool), Kernel>;
static KERNELS: Mutex<Kernels> = Mutex::new(Kernels::new());

/// The kernel of a robot's quantity, on the first device.
///
/// # Errors
/// An unknown robot or quantity; what `Device::open` and `Source::compile` report.
pub fn kernel(robot: i64, quantity: &str, frame: &str, precision: Precision) -> Result<Kernel, String> {
    let key = (robot, quantity.to_string(), frame.to_string(), precision == Precision::F64);
    let mut kernels = KERNELS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(kernel) = kernels.get(&key) {
        return Ok(kernel.clone());
    }
    let entry = registry::find(robot)?;
    let query = call::query(&entry.model, quantity, frame)?;
    let form = Form { precision, layout: CudaLayout::Rows, is_packed: false };
    let packages = PACKAGES.get().map_or(&[][..], Vec::as_slice);
    let made = Device::open(0).and_then(|device| loaded(&entry.model, query, form, &device, packages));
    let kernel = made.map_err(|error| error.to_string())?;
    kernels.insert(key, kernel.clone());
    Ok(kernel)
}

/// The number of states, from the numbers of each array and those of one state.
///
/// # Errors
/// If they do not go together.
pub fn states(kernel: &Kernel, arguments: &[usize], results: &[usize]) -> Result<usize, String> {
    let (inputs, outputs) = (kernel.source().inputs(), kernel.source().outputs());
    let states = arguments.first().zip(inputs.first()).map_or(0, |(found, first)| found / first.length.max(1));
    let fit = |found: &[usize], expected: &[Argument]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(found, x)| *found == states * x.length)
    };
    match fit(arguments, inputs) && fit(results, outputs) {
        true => Ok(states),
        false => Err(format!("arrays of {arguments:?} and {results:?} numbers do not go together")),
    }
}
