//! Errors of GPUs.

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The library of NVIDIA's driver is missing.
    #[error("no CUDA device: NVIDIA's driver was not found; looked for {}", searched.join(", "))]
    NoDriver {
        /// The names that were tried.
        searched: Vec<String>,
    },
    /// There is a driver, but no GPU that it can use.
    #[error("no CUDA device: {reason}")]
    NoDevice {
        /// The driver's reason.
        reason: String,
    },
    /// There is no GPU of this number.
    #[error("CUDA device {found} does not exist, expected a number below {count}")]
    NoSuchDevice {
        /// The requested number.
        found: usize,
        /// The number of devices.
        count: usize,
    },
    /// NVRTC is missing.
    #[error(
        "NVRTC, CUDA's run-time compiler, was not found; `pip install nvidia-cuda-nvrtc` or set MOZZI_NVRTC to \
         libnvrtc.so; looked for {}",
        searched.join(", ")
    )]
    NoCompiler {
        /// The paths and names that were tried.
        searched: Vec<String>,
    },
    /// This library cannot be used as NVRTC.
    #[error("{path} is not NVRTC 11 or newer: {reason}")]
    NotNvrtc {
        /// The library.
        path: String,
        /// The reason, such as a missing symbol.
        reason: String,
    },
    /// NVRTC did not compile a text.
    #[error("NVRTC did not compile {entry} for {arch}: {reason}: {log}")]
    Compile {
        /// The kernel.
        entry: String,
        /// The architecture.
        arch: crate::Arch,
        /// NVRTC's error.
        reason: String,
        /// Its messages.
        log: String,
    },
    /// Not an architecture.
    #[error("the architecture is `{found}`, expected a compute capability such as sm_90")]
    BadArch {
        /// The given text.
        found: String,
    },
    /// A call of the driver failed.
    #[error("CUDA: {call}: {reason}")]
    Driver {
        /// The function of the driver.
        call: &'static str,
        /// The driver's error.
        reason: String,
    },
    /// Kernels do not compute this quantity.
    #[error("{quantity} is not available on a GPU: {reason}")]
    Unsupported {
        /// Its name.
        quantity: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// The program of a robot so large.
    #[error("the program of {quantity} is {error}")]
    TooLong {
        /// The quantity's name.
        quantity: &'static str,
        /// The bound.
        error: mozzi_engine::TooLong,
    },
    /// A wrong number of arrays.
    #[error("{entry} takes {expected} {what}, found {found}")]
    WrongCount {
        /// The kernel.
        entry: String,
        /// `inputs` or `outputs`.
        what: &'static str,
        /// How many were given.
        found: usize,
        /// How many it takes.
        expected: usize,
    },
    /// An array of a wrong length.
    #[error("{what} has {found} numbers, expected {expected}: {states} states of {width}")]
    WrongLength {
        /// The array's name.
        what: String,
        /// Its length.
        found: usize,
        /// The length that the first array's number of states requires.
        expected: usize,
        /// The number of states, from the first array.
        states: usize,
        /// Numbers for each state.
        width: usize,
    },
    /// Another number type than the kernel's.
    #[error("{entry} computes in {expected:?}, found arrays of {found:?}")]
    WrongPrecision {
        /// The kernel.
        entry: String,
        /// The arrays' type.
        found: mozzi_engine::Precision,
        /// The kernel's type.
        expected: mozzi_engine::Precision,
    },
    /// The text could not be emitted.
    #[error(transparent)]
    Emit(#[from] mozzi_engine::EmitError),
    /// An error of the robot or the quantity.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
}
