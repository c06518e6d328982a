//! The interface of a target: an assembler with its forms. Order, allocation, segments, rows, cache and guards are
//! shared; a [`Shape`] has the registers and the cost rules of its machine.

use super::allocate::Line;
use super::instruction::{Operation, Value};
use super::operand::{Memory, Operand, Register};
use super::registers::Pinned;
use super::shape::Shape;

/// The largest number of arrays, including constants and spilled registers: so many general registers hold addresses.
pub const MOST_ARRAYS: usize = 13;

/// The largest frame in bytes.
pub(crate) const LARGEST_FRAME: usize = 1 << 20;

/// The largest frame on the stack, far less than a thread's; the caller provides a larger one, as the last address.
pub(crate) const LARGEST_ON_STACK: usize = 64 << 10;

/// The instructions of one run of the code, by kind; those before and after the loop are not among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// All of them.
    pub instructions: usize,
    /// Arithmetic on numbers, changes of sign among them; a fused multiply-add is one.
    pub arithmetic: usize,
    /// Quotients and square roots, which are among the arithmetic.
    pub divisions: usize,
    /// Operations on bits: signs and quadrants of sines.
    pub bits: usize,
    /// Copies between registers, and numbers moved from lane to lane.
    pub moves: usize,
    /// Reads of memory, as instructions of their own or as operands.
    pub loads: usize,
    /// Writes of memory.
    pub stores: usize,
    /// Loads and stores of values for which there was no register, which are among those.
    pub spills: usize,
    /// Computations of addresses.
    pub addresses: usize,
}

impl Tally {
    /// Counts an operation.
    pub(crate) fn count(&mut self, operation: Operation) {
        *match operation {
            _ if operation.is_of_bits() => &mut self.bits,
            _ if operation.moves_lanes() => &mut self.moves,
            _ => &mut self.arithmetic,
        } += 1;
        self.divisions += usize::from(matches!(operation, Operation::Div | Operation::Sqrt));
    }
}

/// Encodes instructions. It makes machine code memory-safe: it knows the length in bytes of every array, and emits no
/// instruction that reads or writes beyond it, for any input.
pub(crate) trait Assembler: Sized {
    /// Arrays are shorter than this, in bytes: so far its addresses reach.
    const LARGEST_ARRAY: usize;

    /// Code that reads the addresses of all arrays of these sizes in bytes from a list; after them it has a frame of
    /// its own, as the last array.
    fn new(shape: Shape, sizes: &[usize]) -> Self;

    /// Sets the registers of the following instructions.
    fn set_shape(&mut self, shape: Shape);

    /// The array of spilled registers.
    fn frame(&self) -> Memory;

    fn frame_bytes(&self) -> usize;

    /// Begins another segment. Registers are lost between segments, the frame is not.
    fn cut(&mut self);

    /// The bytes of the last segment.
    fn segment_bytes(&self) -> usize;

    fn tally(&mut self) -> &mut Tally;

    /// True if the last operand of this operation can be in memory, as lanes or as one number for all.
    fn takes_memory(&self, operation: Operation) -> bool;

    /// target ← operation(a, b); with one operand: operation(b).
    fn apply(&mut self, operation: Operation, target: Register, a: Register, b: Operand);

    /// The code of an operation on three values, ± a b ± c, and the register of its result.
    fn fused(line: &mut Line<Self>, here: usize, of: (Operation, [Value; 3]), pinned: &mut Pinned) -> Register;

    /// target ← the operand.
    fn load(&mut self, target: Register, from: Operand);

    /// Memory ← a register's lanes.
    fn store(&mut self, to: Memory, byte: usize, from: Register);

    /// Memory ← a register's first numbers; with AVX2, all of them.
    fn store_part(&mut self, to: Memory, byte: usize, from: Register, numbers: usize);

    /// The function of each segment, one after the other, with the places where they begin: (list of addresses, runs).
    /// With steps in bytes, it runs so many times, each array's address a step further every time. Several segments
    /// have a frame for each run, with the last address; a single one has one, on the stack if it is small.
    fn finish(self, steps: &[usize]) -> (Vec<u8>, Vec<usize>);
}

/// The steps of all arrays, and whether the frame, the last array, is on the stack: that of a single segment, if it is
/// small. Several segments have a frame for each run, at addresses of its own, and their frame's size is rounded.
pub(crate) fn with_frame(sizes: &mut [usize], cuts: &[usize], steps: &[usize]) -> (Vec<usize>, bool) {
    let mut steps = steps.to_vec();
    let Some((frame, arrays)) = sizes.split_last_mut() else { return (steps, false) };
    if cuts.is_empty() {
        return (steps, *frame <= LARGEST_ON_STACK);
    }
    *frame = frame.next_multiple_of(64);
    steps.resize(arrays.len(), 0);
    steps.push(*frame);
    (steps, false)
}

/// The parts of a body between its cuts.
pub(crate) fn segments<'b, W>(body: &'b [W], cuts: &'b [usize]) -> impl Iterator<Item = &'b [W]> {
    let starts = [0].into_iter().chain(cuts.iter().copied());
    starts.zip(cuts.iter().copied().chain([body.len()])).map(|(from, to)| &body[from..to])
}
