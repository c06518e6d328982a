//! Programs as machine code.

mod aarch64;
mod allocate;
mod cache;
mod executable;
mod instruction;
mod lower;
mod operand;
mod order;
mod places;
mod registers;
mod rows;
mod segments;
mod shape;
mod signs;
mod sin_cos;
mod target;
mod x86_64;

pub(crate) use instruction::{Node, Operation};
pub use rows::Extent;
pub use shape::Shape;
pub(crate) use sin_cos::SinCos;
pub use target::{MOST_ARRAYS, Tally};

use crate::program::{Array, Program};
use executable::Executable;
use mozzi::scalar::Float;
use shape::Machine;

/// The reason why there is no machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// It was not requested, or refused.
    NotAsked,
    /// The calls so far had too few states to pay for it.
    NotYet,
    /// The processor lacks the instructions, or is neither x86-64 nor AArch64.
    Processor,
    /// The system is one on which machine code for this processor was never made executable: on AArch64, all but Linux,
    /// Android and macOS.
    System,
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
            Refusal::NotYet => "too few states so far to pay for machine code",
            Refusal::Processor => "the processor lacks the instructions",
            Refusal::System => "on AArch64, machine code is for Linux, Android and macOS",
            Refusal::Program => "the program has a function without machine code, or too many arrays",
            Refusal::Long => "the code would not fit the instruction cache",
            Refusal::Memory => "the system forbids executable memory",
        })
    }
}
impl std::error::Error for Refusal {}

/// How the code finds the numbers of its states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// Blocks of a register's states: entry by entry, the lanes of each contiguous.
    Blocks,
    /// Rows of the caller's tables, state by state; for shapes of several states. [Condensed](Kernel::condensing)
    /// outputs, and the squares of angles, are in blocks, one after the other.
    Rows,
}

/// A program as machine code for one or several states at once. It can be shared between threads; calls do not
/// allocate.
#[derive(Debug)]
pub struct Kernel {
    executable: Executable,
    shape: Shape,
    form: Form,
    angle_limit: f64,
    code_bytes: usize,
    tally: Tally,
    frame_bytes: usize,
    flops: usize,
}

impl Kernel {
    /// The machine code of a program.
    ///
    /// # Errors
    /// [`Refusal`] with the reason why there is no machine code.
    pub fn new(program: &Program, shape: Shape) -> Result<Self, Refusal> {
        Self::condensing(program, shape, Form::Blocks, usize::MAX)
    }

    /// The machine code of a program in this form. Each output from index `condensed` on is replaced by its smallest
    /// entry and the sum of its entries, which is enough to check pivots.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    ///
    /// # Panics
    /// For rows of a shape of one state.
    pub fn condensing(program: &Program, shape: Shape, form: Form, condensed: usize) -> Result<Self, Refusal> {
        let cuts = segments::pay(shape);
        Self::cut_if(cuts, program, shape, form, condensed)
    }

    /// As [`condensing`](Self::condensing); long code is cut into [`segments`] if `cuts`.
    fn cut_if(cuts: bool, program: &Program, shape: Shape, form: Form, condensed: usize) -> Result<Self, Refusal> {
        shape.check()?;
        let Made { code, extents, inputs, flops } = made(cuts, program, shape, form, condensed)?;
        let largest = if shape.is_f64() { f64::LARGEST } else { f32::LARGEST.into() };
        let executable = Executable::new(shape, &code, extents, inputs).ok_or(Refusal::Memory)?;
        let (code_bytes, tally, frame_bytes) = (code.bytes.len(), code.tally, code.frame);
        let angle_limit = largest * largest;
        Ok(Kernel { executable, shape, form, angle_limit, code_bytes, tally, frame_bytes, flops })
    }

    /// Its instruction set and number type.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// How it finds the numbers of its states.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The length of the code in bytes.
    pub fn code_bytes(&self) -> usize {
        self.code_bytes
    }

    /// The number of instructions, including loads and stores.
    pub fn instructions(&self) -> usize {
        self.tally.instructions
    }

    /// Its instructions by kind.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Floating-point operations per state, including those of the sines; a fused multiply-add counts as two.
    pub fn flops(&self) -> usize {
        self.flops
    }

    /// Stack memory for spilled registers, in bytes.
    pub fn frame_bytes(&self) -> usize {
        self.frame_bytes
    }

    /// The numbers of each array that a run may touch: of the inputs, of the outputs, and of the squares of angles.
    pub fn extents(&self) -> &[Extent] {
        self.executable.extents()
    }

    /// Fills the outputs of one state for each lane of the shape. The lanes of entry k of an array are contiguous, from
    /// `k · lanes` on. `squares` receives, for each lane, the sum of the squares of all angles whose sine is computed;
    /// see [`is_exact`](Self::is_exact).
    ///
    /// # Panics
    /// If the numbers do not have the shape's type, or an array is missing or too short.
    #[inline(always)]
    pub fn call<S: Float>(&self, inputs: &[&[S]], outputs: &mut [&mut [S]], squares: &mut [S]) {
        self.executable.call(1, inputs, outputs, squares);
    }

    /// Fills the outputs' tables from the inputs', for `runs` registers of states one after the other: after the first,
    /// array k is used from `extents()[k].step` on, and so forth.
    ///
    /// # Panics
    /// As [`call`](Self::call), and if a shape of one state is to run more than once.
    #[inline(always)]
    pub fn run<S: Float>(&self, runs: usize, inputs: &[&[S]], outputs: &mut [&mut [S]], squares: &mut [S]) {
        self.executable.call(runs, inputs, outputs, squares);
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

/// The machine code of a program for any processor, not only this one: to be counted or disassembled, not to be run.
#[derive(Clone, Debug)]
pub struct Listing {
    /// The code; functions of segments one after the other.
    pub code: Vec<u8>,
    /// The instructions of one run, by kind.
    pub tally: Tally,
    /// Stack memory for spilled registers, in bytes.
    pub frame_bytes: usize,
}

impl Listing {
    /// As [`Kernel::condensing`], whatever the processor.
    ///
    /// # Errors
    /// As [`Kernel::new`], but for the processor.
    ///
    /// # Panics
    /// As [`Kernel::condensing`].
    pub fn new(program: &Program, shape: Shape, form: Form, condensed: usize) -> Result<Self, Refusal> {
        let Made { code, .. } = made(segments::pay(shape), program, shape, form, condensed)?;
        Ok(Listing { code: code.bytes, tally: code.tally, frame_bytes: code.frame })
    }
}

/// Code before it is placed in executable memory.
struct Made {
    code: allocate::Code,
    extents: Vec<Extent>,
    inputs: usize,
    flops: usize,
}

fn made(cuts: bool, program: &Program, shape: Shape, form: Form, condensed: usize) -> Result<Made, Refusal> {
    assert!(form == Form::Blocks || !shape.is_scalar(), "one state has no rows");
    let lowered = lower::lower(program, shape, condensed).ok_or(Refusal::Program)?;
    let flops = lowered.flops(shape);
    let widths: Vec<usize> = program.inputs().iter().map(|Array { length, .. }| *length).collect();
    let (inputs, own) = (widths.len(), condensed.min(program.outputs().len()));
    let mut extents = Vec::new();
    extents.extend(widths.iter().map(|&width| match form {
        Form::Blocks => Extent::of_block(width, shape),
        Form::Rows => Extent::of_input(width, shape),
    }));
    extents.extend(lowered.outputs.iter().enumerate().map(|(k, output)| match form {
        Form::Rows if k < own => Extent::of_output(output.len(), shape),
        _ => Extent::of_block(output.len(), shape),
    }));
    let lowered = match shape.machine() {
        Machine::X86_64 => lowered,
        Machine::AArch64 => signs::moved_out(lowered, shape),
    };
    let pays = shape.is_ordered() && lowered.nodes.len() <= order::LONGEST;
    let lowered = if form == Form::Rows { rows::by_rows(lowered, shape, &widths, own) } else { lowered };
    let lowered = if pays { order::ordered(lowered, shape) } else { lowered };
    let segment = if cuts { segments::longest(lowered.nodes.len()) } else { usize::MAX };
    let arrays = allocate::Arrays { extents: &extents, inputs, form, segment };
    let code = match shape.machine() {
        Machine::X86_64 => allocate::allocate::<x86_64::X86>(shape, &lowered, arrays)?,
        Machine::AArch64 => allocate::allocate::<aarch64::Arm>(shape, &lowered, arrays)?,
    };
    match code.bytes.len() > shape.longest_code() {
        true => Err(Refusal::Long),
        false => Ok(Made { code, extents, inputs, flops }),
    }
}
