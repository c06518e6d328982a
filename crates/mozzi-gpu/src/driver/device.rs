//! Devices.

use super::{failed, reason};
use crate::{Arch, Error};
use cudarc::driver::CudaContext;
use cudarc::driver::sys::CUdevice_attribute_enum as Attribute;
use libloading::Library;
use std::sync::Arc;

/// A GPU, with its primary context, which PyTorch, JAX and CuPy use, too. Clones are the same device.
#[derive(Clone, Debug)]
pub struct Device {
    pub(super) context: Arc<CudaContext>,
    pub(super) arch: Arch,
    name: String,
}

/// Names of the driver's library.
const NAMES: [&str; 3] = ["libcuda.so.1", "libcuda.so", "nvcuda.dll"];

impl Device {
    /// Device 0.
    ///
    /// # Errors
    /// See [`open`](Self::open).
    pub fn first() -> Result<Device, Error> {
        Device::open(0)
    }

    /// The device of this number.
    ///
    /// # Errors
    /// [`Error::NoDriver`], [`Error::NoDevice`], [`Error::NoSuchDevice`]; [`Error::Driver`] if it cannot be used.
    pub fn open(number: usize) -> Result<Device, Error> {
        let count = Device::count()?;
        if number >= count {
            return Err(Error::NoSuchDevice { found: number, count });
        }
        let context = CudaContext::new(number).map_err(failed("cuDevicePrimaryCtxRetain"))?;
        let (major, minor) = context.compute_capability().map_err(failed("cuDeviceGetAttribute"))?;
        let [major, minor] = [major, minor].map(|x| u32::try_from(x).unwrap_or(0));
        let name = context.name().map_err(failed("cuDeviceGetName"))?;
        Ok(Device { context, arch: Arch::new(major, minor)?, name })
    }

    /// The number of devices, at least 1.
    ///
    /// # Errors
    /// [`Error::NoDriver`], [`Error::NoDevice`].
    pub fn count() -> Result<usize, Error> {
        check_driver()?;
        let no_device = |reason| Err(Error::NoDevice { reason });
        match CudaContext::device_count() {
            Ok(count @ 1..) => Ok(usize::try_from(count).unwrap_or(0)),
            Ok(_) => no_device("the driver lists none".to_string()),
            Err(error) => no_device(reason(error)),
        }
    }

    /// Its name, such as `NVIDIA H200`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its architecture.
    pub fn arch(&self) -> Arch {
        self.arch
    }

    /// The number of its multiprocessors.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn multiprocessors(&self) -> Result<usize, Error> {
        self.attribute(Attribute::CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT)
    }

    /// Its highest clock, Hz.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn clock_rate(&self) -> Result<f64, Error> {
        Ok(1e3 * self.attribute(Attribute::CU_DEVICE_ATTRIBUTE_CLOCK_RATE)? as f64)
    }

    fn attribute(&self, attribute: Attribute) -> Result<usize, Error> {
        let value = self.context.attribute(attribute).map_err(failed("cuDeviceGetAttribute"))?;
        Ok(usize::try_from(value).unwrap_or(0))
    }

    /// Waits until all work on the device has ended.
    ///
    /// # Errors
    /// [`Error::Driver`] of this or earlier work.
    pub fn synchronize(&self) -> Result<(), Error> {
        self.context.synchronize().map_err(failed("cuCtxSynchronize"))
    }

    pub(super) fn bind(&self) -> Result<(), Error> {
        self.context.bind_to_thread().map_err(failed("cuCtxSetCurrent"))
    }
}

/// cudarc panics if the library is missing or has no functions of CUDA 12.
fn check_driver() -> Result<(), Error> {
    // SAFETY: loading runs the initialization of NVIDIA's library
    let found = NAMES.iter().find_map(|name| unsafe { Library::new(*name) }.ok());
    let Some(library) = found else {
        return Err(Error::NoDriver { searched: NAMES.map(String::from).to_vec() });
    };
    // a function of the newest version that is used here; it is not called
    // SAFETY: only the address is looked up
    match unsafe { library.get::<unsafe extern "C" fn()>(b"cuGetProcAddress_v2") } {
        Ok(_) => Ok(()),
        Err(_) => Err(Error::NoDevice { reason: "the driver is older than CUDA 12.0".to_string() }),
    }
}
