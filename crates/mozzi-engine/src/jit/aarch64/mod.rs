//! Encodes instructions as words: the forms that programs need, of AArch64 with NEON, which every such processor has.
//! SVE is not used: where registers have 128 bits, as on most of those that have it, it computes no faster.
//!
//! Operands are in registers. A fused multiply-add of several lanes overwrites its summand; of one number it overwrites
//! nothing, and has all four signs.

mod encode;
mod function;
mod fused;
#[cfg(test)]
mod tests;

use super::allocate::Line;
use super::instruction::{Grain, Half, Operation, Value};
use super::operand::{Memory, Operand, Register};
use super::registers::Pinned;
use super::shape::Shape;
use super::target::{Assembler, LARGEST_FRAME, MOST_ARRAYS, Tally};
use encode::{add_immediate, lane_two, load_or_store};

/// A general register.
type Address = u8;

/// The register of an array's address is its number after this one: x2 to x14, none of which must be saved. The list of
/// addresses is in x0, the number of runs in x1.
const FIRST_BASE: Address = 2;

/// Registers for addresses within arrays beyond the reach of an instruction.
const POINTERS: [Address; 2] = [16, 17];

pub(crate) struct Arm {
    shape: Shape,
    /// The length of each array in bytes.
    sizes: Vec<usize>,
    /// The index of the array that is the frame; the frame grows.
    frame: Memory,
    body: Vec<u32>,
    /// Where the body's segments begin, but for the first.
    cuts: Vec<usize>,
    tally: Tally,
    /// The registers in use, as bits.
    used: u32,
    /// The contents of [`POINTERS`], an array and a byte each, and the index of the one that is replaced next.
    pointers: [Option<(Memory, usize)>; 2],
    next_pointer: usize,
}

/// The number of a register, so that those that must be saved for the caller, v8 to v15, are taken last.
fn number(register: Register) -> u32 {
    match register {
        0..8 => register.into(),
        8..24 => u32::from(register) + 8,
        24..32 => u32::from(register) - 16,
        _ => unreachable!("no such register"),
    }
}

impl Assembler for Arm {
    const LARGEST_ARRAY: usize = 1 << 24;

    fn new(shape: Shape, sizes: &[usize]) -> Self {
        assert!(sizes.len() < MOST_ARRAYS, "{} arrays", sizes.len());
        let sizes = [sizes, &[0]].concat();
        Arm {
            shape,
            frame: sizes.len() - 1,
            sizes,
            body: Vec::new(),
            cuts: Vec::new(),
            tally: Tally::default(),
            used: 0,
            pointers: [None; 2],
            next_pointer: 0,
        }
    }

    fn set_shape(&mut self, shape: Shape) {
        self.shape = shape;
    }

    fn frame(&self) -> Memory {
        self.frame
    }

    fn frame_bytes(&self) -> usize {
        self.sizes[self.frame]
    }

    fn cut(&mut self) {
        self.cuts.push(self.body.len());
        self.pointers = [None; 2];
    }

    fn segment_bytes(&self) -> usize {
        4 * (self.body.len() - self.cuts.last().unwrap_or(&0))
    }

    fn tally(&mut self) -> &mut Tally {
        &mut self.tally
    }

    fn takes_memory(&self, _: Operation) -> bool {
        false
    }

    fn apply(&mut self, operation: Operation, target: Register, a: Register, b: Operand) {
        let Operand::Register(b) = b else { unreachable!("operands are in registers") };
        self.tally.count(operation);
        let word = self.word_of(operation);
        // with one operand, it takes the first place
        if operation.arity() == 1 { self.three(word, target, b, 0) } else { self.three(word, target, a, b) }
    }

    fn fused(line: &mut Line<Self>, here: usize, of: (Operation, [Value; 3]), pinned: &mut Pinned) -> Register {
        line.of_three(here, of, pinned)
    }

    fn load(&mut self, target: Register, from: Operand) {
        match from {
            Operand::Register(from) => self.copy(target, from),
            Operand::Lanes(memory, byte) => {
                self.tally.loads += 1;
                self.access(true, target, memory, byte, self.shape.width());
            }
            Operand::Repeated(..) => unreachable!("constants are in every lane"),
        }
    }

    fn store(&mut self, to: Memory, byte: usize, from: Register) {
        self.store_part(to, byte, from, self.shape.lanes());
    }

    fn store_part(&mut self, to: Memory, byte: usize, from: Register, numbers: usize) {
        let size = self.shape.number() * numbers;
        self.tally.stores += 1;
        if size.is_power_of_two() {
            return self.access(false, from, to, byte, size);
        }
        // three numbers of four
        self.access(false, from, to, byte, 8);
        self.tally.stores += 1;
        self.bound(to, byte + 12);
        let (pointer, from) = (self.pointer(to, byte + 8), self.register(from));
        self.emit(lane_two(from, pointer));
    }

    fn finish(self, steps: &[usize]) -> (Vec<u8>, Vec<usize>) {
        self.functions(steps)
    }
}

impl Arm {
    fn emit(&mut self, word: u32) {
        self.tally.instructions += 1;
        self.body.push(word);
    }

    /// A register's number; it is in use from now on.
    fn register(&mut self, register: Register) -> u32 {
        let number = number(register);
        self.used |= 1 << number;
        number
    }

    /// target ← word(a, b).
    fn three(&mut self, word: u32, target: Register, a: Register, b: Register) {
        let [target, a, b] = [target, a, b].map(|register| self.register(register));
        self.emit(word | b << 16 | a << 5 | target);
    }

    /// The instruction of an operation on one or two values, without its registers.
    fn word_of(&self, operation: Operation) -> u32 {
        let (is_scalar, is_f64) = (self.shape.is_scalar(), self.shape.is_f64());
        // bit 22 is the size of numbers
        let numbers = |scalar: u32, lanes: u32| if is_scalar { scalar } else { lanes } | u32::from(is_f64) << 22;
        // bit 30 is 128 bits, not 64
        let bits = |word: u32| word | u32::from(!is_scalar) << 30;
        match operation {
            Operation::Add => numbers(0x1e20_2800, 0x4e20_d400),
            Operation::Sub => numbers(0x1e20_3800, 0x4ea0_d400),
            Operation::Mul => numbers(0x1e20_0800, 0x6e20_dc00),
            Operation::Div => numbers(0x1e20_1800, 0x6e20_fc00),
            Operation::Min => numbers(0x1e20_5800, 0x4ea0_f400),
            Operation::Max => numbers(0x1e20_4800, 0x4e20_f400),
            Operation::Sqrt => numbers(0x1e21_c000, 0x6ea1_f800),
            Operation::Neg => numbers(0x1e21_4000, 0x6ea0_f800),
            Operation::And => bits(0x0e20_1c00),
            Operation::Xor => bits(0x2e20_1c00),
            Operation::SubBits if is_scalar && is_f64 => 0x7ee0_8400, // 64 bits are one number, of another form
            Operation::SubBits => bits(0x2ea0_8400) | u32::from(is_f64) << 22,
            Operation::ShiftLeft(by) if is_scalar && is_f64 => 0x5f00_5400 | (64 + u32::from(by)) << 16,
            Operation::ShiftLeft(by) => bits(0x0f00_5400) | (8 * self.shape.number() as u32 + u32::from(by)) << 16,
            Operation::Interleave(half, grain) => {
                0x4e80_3800 | u32::from(grain == Grain::Bits64) << 22 | u32::from(half == Half::Upper) << 14
            }
            Operation::Pick(_) => unreachable!("128 bits are a register"),
            Operation::MulAdd | Operation::MulSub | Operation::NegMulAdd | Operation::NegMulSub | Operation::Select => {
                unreachable!("three operands")
            }
        }
    }

    /// target ← a register.
    fn copy(&mut self, target: Register, from: Register) {
        self.tally.moves += 1;
        let (target, from) = (self.register(target), self.register(from));
        let word = match (self.shape.is_scalar(), self.shape.is_f64()) {
            (true, true) => 0x1e60_4000,
            (true, false) => 0x1e20_4000,
            (false, _) => 0x4ea0_1c00 | from << 16,
        };
        self.emit(word | from << 5 | target);
    }

    /// target ← ± a b ± c of one number.
    fn product_of_one(&mut self, operation: Operation, target: Register, [a, b, c]: [Register; 3]) {
        self.tally.count(operation);
        let (subtracts, negates) = match operation {
            Operation::MulAdd => (0, 0),
            Operation::MulSub => (1, 1),
            Operation::NegMulAdd => (1, 0),
            Operation::NegMulSub => (0, 1),
            _ => unreachable!("not a fused product"),
        };
        let word = 0x1f00_0000 | u32::from(self.shape.is_f64()) << 22 | negates << 21 | subtracts << 15;
        let c = self.register(c) << 10;
        self.three(word | c, target, a, b);
    }

    /// target ← target + a b or target − a b, of several lanes.
    fn product_of_lanes(&mut self, operation: Operation, target: Register, [a, b]: [Register; 2]) {
        self.tally.count(operation);
        let subtracts = match operation {
            Operation::MulAdd => 0,
            Operation::NegMulAdd => 1,
            _ => unreachable!("not an instruction of several lanes"),
        };
        self.three(0x4e20_cc00 | u32::from(self.shape.is_f64()) << 22 | subtracts << 23, target, a, b);
    }

    /// target ← target where the bits of `odd` are not set, else a; or the other way round.
    fn insert(&mut self, where_set: bool, target: Register, a: Register, odd: Register) {
        self.tally.count(Operation::Select);
        let word = 0x2ea0_1c00 | u32::from(!self.shape.is_scalar()) << 30 | u32::from(!where_set) << 22;
        self.three(word, target, a, odd);
    }

    /// Loads or stores so many bytes.
    fn access(&mut self, is_load: bool, register: Register, memory: Memory, byte: usize, size: usize) {
        self.bound(memory, byte + size);
        if memory == self.frame && byte + size > LARGEST_FRAME {
            return; // such a frame is refused at the end
        }
        let register = self.register(register);
        let (pointer, rest) = match byte {
            _ if encode::reaches(byte, size) => (FIRST_BASE + memory as Address, byte),
            _ => {
                let rest = byte % (4096 * size) / size * size;
                (self.pointer(memory, byte - rest), rest)
            }
        };
        self.emit(load_or_store(is_load, register, pointer, rest, size));
    }

    /// A register with the address of this byte.
    fn pointer(&mut self, memory: Memory, byte: usize) -> Address {
        if let Some(known) = self.pointers.iter().position(|&known| known == Some((memory, byte))) {
            return POINTERS[known];
        }
        let place = self.next_pointer;
        self.next_pointer = 1 - place;
        self.pointers[place] = Some((memory, byte));
        let mut from = FIRST_BASE + memory as Address;
        for word in add_immediate(POINTERS[place], byte) {
            self.tally.addresses += 1;
            self.emit(word | u32::from(from) << 5);
            from = POINTERS[place];
        }
        POINTERS[place]
    }

    /// An access ends before this byte.
    fn bound(&mut self, memory: Memory, end: usize) {
        if memory == self.frame {
            self.sizes[memory] = self.sizes[memory].max(end);
        }
        assert!(end <= self.sizes[memory], "byte {end} of array {memory}");
    }
}
