//! The engines that compute quantities.

use crate::{Kernel, Refusal, Shape};
use std::fmt;
use std::sync::Arc;

/// The engine that computes a quantity, at one state or in arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Machine code of this shape, and its length in bytes.
    MachineCode(Shape, usize),
    /// The kernels, and the reason why there is no machine code.
    Kernels(Refusal),
}

impl Engine {
    pub(crate) fn of(code: &Result<Arc<Kernel>, Refusal>) -> Self {
        match code {
            Ok(kernel) => Engine::MachineCode(kernel.shape(), kernel.code_bytes()),
            Err(refusal) => Engine::Kernels(*refusal),
        }
    }
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Engine::MachineCode(shape, bytes) => write!(f, "machine code ({}), {bytes} bytes", shape.instruction_set()),
            Engine::Kernels(refusal) => write!(f, "kernels: {refusal}"),
        }
    }
}
