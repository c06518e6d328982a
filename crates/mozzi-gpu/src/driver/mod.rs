//! NVIDIA's driver: devices, their memory, kernels. The library is loaded at the first use.

mod array;
mod device;
mod kernel;
mod rollout;

pub use array::DeviceArray;
pub use device::Device;
pub use kernel::{Kernel, Stream};
pub use rollout::{Rollout, RolloutArrays, RolloutInputs, Steps};

use crate::Error;
use cudarc::driver::DriverError;
use cudarc::driver::sys::CUresult;

/// The error of a call.
fn failed(call: &'static str) -> impl Fn(DriverError) -> Error {
    move |error| Error::Driver { call, reason: reason(error) }
}

/// The driver's own words, such as `CUDA_ERROR_NO_DEVICE: no CUDA-capable device is detected`.
fn reason(error: DriverError) -> String {
    let name = error.error_name().map(|name| name.to_string_lossy().into_owned());
    let words = error.error_string().map(|words| words.to_string_lossy().into_owned());
    match (name, words) {
        (Ok(name), Ok(words)) => format!("{name}: {words}"),
        _ => {
            let DriverError(result): DriverError = error;
            let result: CUresult = result;
            format!("error {}", result as u32)
        }
    }
}
