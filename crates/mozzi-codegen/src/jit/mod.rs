//! Programs as machine code.

mod allocate;
mod assembler;
mod cache;
mod executable;
mod instruction;
mod lower;
mod order;
mod shape;
mod sin_cos;

pub(crate) use instruction::{Node, Operation};
pub use shape::Shape;
pub(crate) use sin_cos::SinCos;

use crate::program::{Array, Program};
use executable::Executable;
use mozzi::scalar::Float;

/// The reason why there is no machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It was not requested.
    NotAsked,
    /// The processor lacks the instructions, or is not x86-64.
    Processor,
    /// The program has a function without machine code (tanh), or more arrays than there are registers for their
    /// addresses.
    Program,
    /// The code would be longer than [`Shape::longest_code`]; the kernels are faster then.
    Long,
    /// The system does not allow executable memory.
    Memory,
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Refusal::NotAsked => "machine code was not requested",
            Refusal::Processor => "the processor has not the instructions",
            Refusal::Program => "the program has a function without machine code, or too many arrays",
            Refusal::Long => "the code would be longer than the caches serve",
            Refusal::Memory => "the system grants no executable memory",
        })
    }
}
impl std::error::Error for Refusal {}

/// A program as machine code for one or several states at once. It can be shared between threads; calls do not
/// allocate.
#[derive(Debug)]
pub struct Kernel {
    executable: Executable,
    shape: Shape,
    angle_limit: f64,
    code_bytes: usize,
    instructions: usize,
    frame_bytes: usize,
    flops: usize,
}

impl Kernel {
    /// The machine code of a program.
    ///
    /// # Errors
    /// [`Refusal`] with the reason why there is no machine code.
    pub fn new(program: &Program, shape: Shape) -> Result<Self, Refusal> {
        Self::condensing(program, shape, usize::MAX)
    }

    /// Likewise, but each output from index `condensed` on is replaced by its smallest entry and the sum of its
    /// entries, which is enough to check pivots.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn condensing(program: &Program, shape: Shape, condensed: usize) -> Result<Self, Refusal> {
        if !shape.is_supported() {
            return Err(Refusal::Processor);
        }
        let lowered = lower::lower(program, shape, condensed).ok_or(Refusal::Program)?;
        let inputs: Vec<usize> = program.inputs().iter().map(|Array { length, .. }| *length).collect();
        let outputs: Vec<usize> = lowered.outputs.iter().map(Vec::len).collect();
        let flops = lowered.flops();
        let pays = shape.repeats() && lowered.nodes.len() <= order::LONGEST;
        let lowered = if pays { order::ordered(lowered) } else { lowered };
        let code = allocate::allocate(shape, &lowered, &inputs)?;
        if code.bytes.len() > shape.longest_code() {
            return Err(Refusal::Long);
        }
        let largest = if shape.is_f64() { f64::LARGEST } else { f32::LARGEST.into() };
        let executable = Executable::new(shape, &code, &inputs, &outputs).ok_or(Refusal::Memory)?;
        let (code_bytes, instructions, frame_bytes) = (code.bytes.len(), code.instructions, code.frame);
        Ok(Kernel { executable, shape, angle_limit: largest * largest, code_bytes, instructions, frame_bytes, flops })
    }

    /// Its instruction set and number type.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The length of the code in bytes.
    pub fn code_bytes(&self) -> usize {
        self.code_bytes
    }

    /// The number of instructions, including loads and stores.
    pub fn instructions(&self) -> usize {
        self.instructions
    }

    /// Floating-point operations per state, including those of the sines; a fused multiply-add counts as two.
    pub fn flops(&self) -> usize {
        self.flops
    }

    /// Stack memory for spilled registers, in bytes.
    pub fn frame_bytes(&self) -> usize {
        self.frame_bytes
    }

    /// Fills the outputs of one state for each lane of the shape. The lanes of entry k of an array are contiguous, from
    /// `k · lanes` on. `squares` receives, for each lane, the sum of the squares of all angles whose sine is computed;
    /// see [`is_exact`](Self::is_exact).
    ///
    /// # Panics
    /// If the numbers do not have the shape's type, or an array is missing or too short.
    #[inline(always)]
    pub fn call<S: Float>(&self, inputs: &[&[S]], outputs: &mut [&mut [S]], squares: &mut [S]) {
        self.executable.call(inputs, outputs, squares);
    }

    /// As [`call`](Self::call), with the inputs one after the other in one slice and the outputs in another.
    ///
    /// # Panics
    /// If the numbers do not have the shape's type, or a slice is too short.
    #[inline(always)]
    pub fn call_joined<S: Float>(&self, inputs: &[S], outputs: &mut [S], squares: &mut [S]) {
        self.executable.call_joined(inputs, outputs, squares);
    }

    /// The largest sum of squares for which angles are reduced exactly.
    #[inline(always)]
    pub fn angle_limit(&self) -> f64 {
        self.angle_limit
    }

    /// True if all angles of a lane are within the range of exact reduction. If false, or NaN, the lane's outputs are
    /// invalid.
    #[inline(always)]
    pub fn is_exact<S: Float>(&self, squares: S) -> bool {
        squares <= S::from_f64(self.angle_limit)
    }
}
