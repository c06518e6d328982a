//! A device's memory.

use super::{Device, failed};
use crate::{Error, Number};
use cudarc::driver::result;
use std::marker::PhantomData;

/// Numbers in a device's memory, freed at the end.
#[derive(Debug)]
pub struct DeviceArray<T> {
    device: Device,
    pointer: u64,
    length: usize,
    number: PhantomData<T>,
}

impl Device {
    /// Memory for this many numbers, all 0.
    ///
    /// # Errors
    /// [`Error::Driver`] if there is not enough.
    pub fn zeros<T: Number>(&self, length: usize) -> Result<DeviceArray<T>, Error> {
        DeviceArray::zeros(self, length)
    }

    /// A copy of these numbers.
    ///
    /// # Errors
    /// See [`zeros`](Self::zeros).
    pub fn copy<T: Number>(&self, numbers: &[T]) -> Result<DeviceArray<T>, Error> {
        let mut array = self.zeros(numbers.len())?;
        array.write(numbers)?;
        Ok(array)
    }
}

impl<T: Number> DeviceArray<T> {
    fn zeros(device: &Device, length: usize) -> Result<Self, Error> {
        device.bind()?;
        let bytes = length * size_of::<T>();
        // an empty array has a pointer, too
        // SAFETY: the context is current; the memory is freed once, in `drop`
        let pointer = unsafe { result::malloc_sync(bytes.max(1)) }.map_err(failed("cuMemAlloc"))?;
        let array = DeviceArray { device: device.clone(), pointer, length, number: PhantomData };
        // SAFETY: as many bytes as were allocated
        unsafe { result::memset_d8_sync(pointer, 0, bytes.max(1)) }.map_err(failed("cuMemsetD8"))?;
        Ok(array)
    }

    /// The number of its entries.
    pub fn len(&self) -> usize {
        self.length
    }

    /// True if it has no entries.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Its address on the device.
    pub fn pointer(&self) -> u64 {
        self.pointer
    }

    /// Copies numbers to the device, and waits for it.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::Driver`].
    pub fn write(&mut self, numbers: &[T]) -> Result<(), Error> {
        self.check("the source", numbers.len())?;
        self.device.bind()?;
        // SAFETY: both have as many numbers
        unsafe { result::memcpy_htod_sync(self.pointer, numbers) }.map_err(failed("cuMemcpyHtoD"))
    }

    /// Copies the numbers from the device, after all earlier work on the legacy default stream.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::Driver`].
    pub fn read(&self, numbers: &mut [T]) -> Result<(), Error> {
        self.check("the destination", numbers.len())?;
        self.device.bind()?;
        // SAFETY: both have as many numbers, and all bits are numbers
        unsafe { result::memcpy_dtoh_sync(numbers, self.pointer) }.map_err(failed("cuMemcpyDtoH"))
    }

    /// [`read`](Self::read) into a new vector.
    ///
    /// # Errors
    /// See [`read`](Self::read).
    pub fn to_vec(&self) -> Result<Vec<T>, Error> {
        let mut numbers = vec![T::default(); self.length];
        self.read(&mut numbers)?;
        Ok(numbers)
    }

    fn check(&self, what: &str, found: usize) -> Result<(), Error> {
        match found == self.length {
            true => Ok(()),
            false => {
                let (what, expected) = (what.to_string(), self.length);
                Err(Error::WrongLength { what, found, expected, states: expected, width: 1 })
            }
        }
    }
}

impl<T> Drop for DeviceArray<T> {
    fn drop(&mut self) {
        if self.device.bind().is_ok() {
            // SAFETY: allocated in `zeros` and freed only here; the driver waits for kernels that use it. An error is
            // one of an earlier kernel, which the next call reports.
            let _ = unsafe { result::free_sync(self.pointer) };
        }
    }
}
