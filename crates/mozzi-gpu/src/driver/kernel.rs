//! A loaded kernel, and its calls.

use super::{Device, DeviceArray, failed};
use crate::{Binary, Error, Number, Nvrtc, Source};
use cudarc::driver::result;
use cudarc::driver::sys;
use mozzi_engine::CudaLayout;
use std::ffi::{CString, c_void};
use std::sync::Arc;

/// A stream of the caller: a `CUstream` or `cudaStream_t` as an address. The default is the legacy default stream, 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stream(pub usize);

/// A quantity's kernel on a device. Clones share it.
#[derive(Clone, Debug)]
pub struct Kernel {
    device: Device,
    source: Source,
    module: Arc<Module>,
}

/// The loaded code.
#[derive(Debug)]
struct Module {
    device: Device,
    module: sys::CUmodule,
    function: sys::CUfunction,
}

// SAFETY: the driver's handles may be used by any thread; each call makes the context current first
unsafe impl Send for Module {}
// SAFETY: as above; nothing is changed after loading
unsafe impl Sync for Module {}

impl Drop for Module {
    fn drop(&mut self) {
        if self.device.bind().is_ok() {
            // SAFETY: loaded in `Kernel::load`, and unloaded only here; an error is one of an earlier kernel
            let _ = unsafe { result::module::unload(self.module) };
        }
    }
}

impl Device {
    /// Compiles a text by [`Nvrtc::find`] for this device, and loads it. Loading again costs a millisecond, not a
    /// compilation.
    ///
    /// # Errors
    /// [`Error::NoCompiler`], [`Error::Compile`], [`Error::Driver`].
    pub fn kernel(&self, source: &Source) -> Result<Kernel, Error> {
        self.load(source, &*source.compile(&Nvrtc::find()?, self.arch)?)
    }

    /// Loads a text's code.
    ///
    /// # Errors
    /// [`Error::Driver`], for example if the code is for another architecture.
    pub fn load(&self, source: &Source, binary: &Binary) -> Result<Kernel, Error> {
        Kernel::load(self, source, binary)
    }
}

impl Kernel {
    fn load(device: &Device, source: &Source, binary: &Binary) -> Result<Kernel, Error> {
        device.bind()?;
        let name = CString::new(binary.entry()).unwrap_or_default(); // an identifier of C has no 0
        // SAFETY: a CUBIN of NVRTC, whose header has its length
        let module = unsafe { result::module::load_data(binary.code().as_ptr().cast()) };
        let module = module.map_err(failed("cuModuleLoadData"))?;
        let mut loaded = Module { device: device.clone(), module, function: std::ptr::null_mut() };
        // SAFETY: the module was just loaded
        let function = unsafe { result::module::get_function(module, name) };
        loaded.function = function.map_err(failed("cuModuleGetFunction"))?;
        Ok(Kernel { device: device.clone(), source: source.clone(), module: Arc::new(loaded) })
    }

    /// Its device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Its text, with names and lengths of its arrays.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The 32-bit registers of a thread.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn registers(&self) -> Result<usize, Error> {
        let attribute = sys::CUfunction_attribute_enum::CU_FUNC_ATTRIBUTE_NUM_REGS;
        self.device.bind()?;
        // SAFETY: the function is loaded
        let count = unsafe { result::function::get_function_attribute(self.module.function, attribute) };
        count.map(|count| usize::try_from(count).unwrap_or(0)).map_err(failed("cuFuncGetAttribute"))
    }

    /// Launches it on arrays of the device, given by their addresses, inputs and outputs in the order of
    /// [`Source::inputs`] and [`Source::outputs`], each with its length times `states` numbers. It neither waits nor
    /// allocates, so that it can be captured in a CUDA graph.
    ///
    /// # Errors
    /// [`Error::WrongCount`], [`Error::Driver`].
    ///
    /// # Safety
    /// The addresses are of this device's memory, aligned to their numbers, with that many numbers, alive until the
    /// kernel has ended; no output overlaps another array. The stream is one of the device's primary context.
    pub unsafe fn launch(&self, inputs: &[u64], outputs: &[u64], states: usize, stream: Stream) -> Result<(), Error> {
        self.check_count("inputs", inputs.len(), self.source.inputs.len())?;
        self.check_count("outputs", outputs.len(), self.source.outputs.len())?;
        let count = states as u64;
        let numbers = inputs.iter().chain(outputs).chain([&count]);
        let mut parameters: Vec<*mut c_void> = numbers.map(|x| std::ptr::from_ref(x).cast_mut().cast()).collect();
        // SAFETY: pointers and a number, as the text declares; the caller answers for the addresses and the stream
        unsafe { self.launch_with(&mut parameters, states, stream) }
    }

    /// Launches it with these parameters, each given by its address.
    ///
    /// # Safety
    /// The parameters are those of the text. See [`launch`](Self::launch).
    pub(super) unsafe fn launch_with(
        &self,
        parameters: &mut [*mut c_void],
        states: usize,
        Stream(stream): Stream,
    ) -> Result<(), Error> {
        if states == 0 {
            return Ok(());
        }
        self.device.bind()?;
        // strides of columns have 32 bits
        let all =
            u32::try_from(states).map_err(|_| Error::Driver { call: "cuLaunchKernel", reason: too_many(states) })?;
        let threads = u32::try_from(self.source.threads()).unwrap_or(u32::MAX);
        let (grid, block) = ((self.blocks(all, threads)?, 1, 1), (threads, 1, 1));
        let stream = stream as sys::CUstream;
        // SAFETY: the function is loaded; the parameters are copied during the call; the caller answers for the rest
        unsafe { result::launch_kernel(self.module.function, grid, block, 0, stream, parameters) }
            .map_err(failed("cuLaunchKernel"))
    }

    /// Blocks for these states: a thread takes several states if the kernel is in parts and there are enough states to
    /// occupy all multiprocessors.
    fn blocks(&self, states: u32, threads: u32) -> Result<u32, Error> {
        /// Threads of a multiprocessor if each has all registers that it can have.
        const RESIDENT: u32 = 256;
        let blocks = states.div_ceil(threads);
        let states_of_thread = u32::try_from(self.source.states_of_thread()).unwrap_or(1);
        if states_of_thread == 1 {
            return Ok(blocks);
        }
        let multiprocessors = u32::try_from(self.device.multiprocessors()?).unwrap_or(u32::MAX);
        let all = multiprocessors.saturating_mul(RESIDENT.div_ceil(threads));
        Ok(blocks.min(blocks.div_ceil(states_of_thread).max(all)))
    }

    /// Launches it on arrays of the device, on the legacy default stream.
    ///
    /// # Errors
    /// [`Error::WrongPrecision`], [`Error::WrongCount`], [`Error::WrongLength`], [`Error::Driver`].
    pub fn run<T: Number>(&self, inputs: &[&DeviceArray<T>], outputs: &mut [&mut DeviceArray<T>]) -> Result<(), Error> {
        let lengths: Vec<usize> = inputs.iter().map(|x| x.len()).collect();
        let states = self.source.states::<T>(&lengths)?;
        let lengths: Vec<usize> = outputs.iter().map(|x| x.len()).collect();
        self.check_count("outputs", lengths.len(), self.source.outputs.len())?;
        for (output, &found) in self.source.outputs.iter().zip(&lengths) {
            output.check(found, states)?;
        }
        let inputs: Vec<u64> = inputs.iter().map(|x| x.pointer()).collect();
        let outputs: Vec<u64> = outputs.iter().map(|x| x.pointer()).collect();
        // SAFETY: living arrays of checked lengths; exclusive borrows do not overlap; freeing waits for the kernel
        unsafe { self.launch(&inputs, &outputs, states, Stream::default()) }
    }

    /// Copies arrays of the host to the device, runs the kernel, and copies the outputs back.
    ///
    /// # Errors
    /// See [`run`](Self::run).
    pub fn compute<T: Number>(&self, inputs: &[&[T]]) -> Result<Vec<Vec<T>>, Error> {
        let states = self.source.states::<T>(&inputs.iter().map(|x| x.len()).collect::<Vec<_>>())?;
        let inputs = inputs.iter().map(|x| self.device.copy(x)).collect::<Result<Vec<_>, _>>()?;
        let zeros = self.source.outputs.iter().map(|output| self.device.zeros(output.length * states));
        let mut outputs = zeros.collect::<Result<Vec<DeviceArray<T>>, _>>()?;
        self.run(&inputs.iter().collect::<Vec<_>>(), &mut outputs.iter_mut().collect::<Vec<_>>())?;
        outputs.iter().map(DeviceArray::to_vec).collect()
    }

    fn check_count(&self, what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
        match found == expected {
            true => Ok(()),
            false => Err(Error::WrongCount { entry: self.source.entry.clone(), what, found, expected }),
        }
    }

    /// The layout of its arrays.
    pub fn layout(&self) -> CudaLayout {
        self.source.form.layout
    }
}

fn too_many(states: usize) -> String {
    format!("{states} states, expected at most {}", u32::MAX)
}
