//! Encodes instructions as bytes: the forms that programs need, of x86-64 with VEX (AVX2, FMA) and with EVEX (AVX-512)
//! prefixes.

mod function;
mod fused;
#[cfg(test)]
mod tests;

use super::allocate::Line;
use super::instruction::{Grain, Half, Operation, Value};
use super::operand::{Memory, Operand, Register};
use super::registers::Pinned;
use super::shape::{Encoding, Shape};
use super::target::{Assembler, MOST_ARRAYS, Tally};

/// General registers for the arrays' addresses; rdi, which passes them, is the last of those that need not be saved.
/// `rsp` and `r12` are left out: as base registers they need another encoding.
const BASES: [u8; MOST_ARRAYS] = [0, 1, 2, 6, 8, 9, 10, 11, 7, 3, 13, 14, 15];

/// Opcode map, mandatory prefix (0 none, 1 66, 2 F3, 3 F2), the bit W, opcode.
#[derive(Clone, Copy)]
struct Form {
    map: u8,
    prefix: u8,
    wide: bool,
    opcode: u8,
}

impl Form {
    fn is_broadcast(self) -> bool {
        self.map == 2 && matches!(self.opcode, 0x18 | 0x19)
    }
}

pub(crate) struct X86 {
    shape: Shape,
    /// The length of each array in bytes.
    sizes: Vec<usize>,
    /// The index of the array that is the frame; the frame grows.
    frame: Memory,
    body: Vec<u8>,
    /// Where the body's segments begin, but for the first.
    cuts: Vec<usize>,
    tally: Tally,
    /// The numbers that each mask lets through, from the register k1 on.
    masks: Vec<usize>,
}

/// The opcode of stores, which no other form has.
const STORE: u8 = 0x11;

/// A mask register; 0 is none.
type Mask = u8;

/// The masks that there are.
const MOST_MASKS: usize = 7;

impl Assembler for X86 {
    const LARGEST_ARRAY: usize = i32::MAX as usize;

    fn new(shape: Shape, sizes: &[usize]) -> Self {
        assert!(sizes.len() < MOST_ARRAYS, "{} arrays", sizes.len());
        let sizes = [sizes, &[0]].concat();
        let (body, cuts, masks) = (Vec::new(), Vec::new(), Vec::new());
        X86 { shape, frame: sizes.len() - 1, sizes, body, cuts, tally: Tally::default(), masks }
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
    }

    fn segment_bytes(&self) -> usize {
        self.body.len() - self.cuts.last().unwrap_or(&0)
    }

    fn tally(&mut self) -> &mut Tally {
        &mut self.tally
    }

    fn takes_memory(&self, operation: Operation) -> bool {
        match operation {
            Operation::Sqrt | Operation::ShiftLeft(_) => false,
            // a repeated number would be one of 64 bits
            Operation::Interleave(_, Grain::Bits64) => self.shape.is_f64(),
            // the scalar forms of bit operations read sixteen bytes
            _ if operation.is_of_bits() => !self.shape.is_scalar(),
            _ => true,
        }
    }

    fn apply(&mut self, operation: Operation, target: Register, a: Register, b: Operand) {
        self.tally.count(operation);
        let form = match operation {
            Operation::Add => self.arithmetic(0x58),
            Operation::Mul => self.arithmetic(0x59),
            Operation::Sub => self.arithmetic(0x5c),
            Operation::Min => self.arithmetic(0x5d),
            Operation::Div => self.arithmetic(0x5e),
            Operation::Max => self.arithmetic(0x5f),
            Operation::Sqrt => self.arithmetic(0x51),
            Operation::And => self.bits(0xdb, 0xdb),
            Operation::Xor => self.bits(0xef, 0xef),
            Operation::SubBits => self.bits(0xfb, 0xfa),
            Operation::ShiftLeft(by) => {
                // here the target takes the field of the first operand, and 6 the field of the target
                let form = self.bits(0x73, 0x72);
                self.instruction(form, 6, target, b);
                self.body.push(by);
                return;
            }
            Operation::Interleave(half, grain) => {
                let (opcode, is_64) = (0x14 + u8::from(half == Half::Upper), grain == Grain::Bits64);
                Form { map: 1, prefix: u8::from(is_64), wide: self.is_evex() && is_64, opcode }
            }
            Operation::Pick(places) => {
                let (wide, opcode) = if self.is_evex() { (self.shape.is_f64(), 0x23) } else { (false, 0x06) };
                self.instruction(Form { map: 3, prefix: 1, wide, opcode }, target, a, b);
                self.body.push(places);
                return;
            }
            Operation::MulAdd | Operation::MulSub | Operation::NegMulAdd | Operation::NegMulSub => {
                unreachable!("three operands")
            }
            Operation::Neg | Operation::Select => unreachable!("of AArch64"),
        };
        // packed square roots have one operand, and the other field must be 0
        let a = if operation == Operation::Sqrt && !self.shape.is_scalar() { 0 } else { a };
        self.instruction(form, target, a, b);
    }

    fn fused(line: &mut Line<Self>, here: usize, of: (Operation, [Value; 3]), pinned: &mut Pinned) -> Register {
        line.fused(here, of, pinned)
    }

    fn load(&mut self, target: Register, from: Operand) {
        self.tally.moves += usize::from(matches!(from, Operand::Register(_)));
        let form = match from {
            Operand::Register(_) => Form { prefix: u8::from(self.shape.is_f64()), ..self.arithmetic(0x28) },
            Operand::Lanes(..) => self.arithmetic(0x10),
            Operand::Repeated(..) => {
                let opcode = if self.shape.is_f64() { 0x19 } else { 0x18 };
                Form { map: 2, prefix: 1, wide: self.is_evex() && self.shape.is_f64(), opcode }
            }
        };
        self.instruction(form, target, 0, from);
    }

    fn store(&mut self, to: Memory, byte: usize, from: Register) {
        self.store_part(to, byte, from, self.shape.lanes());
    }

    fn store_part(&mut self, to: Memory, byte: usize, from: Register, numbers: usize) {
        let mask = if numbers < self.shape.lanes() && self.is_evex() { self.mask(numbers) } else { 0 };
        self.tally.stores += 1;
        let form = self.arithmetic(STORE);
        self.masked(form, from, 0, Operand::Lanes(to, byte), mask);
    }

    fn finish(self, steps: &[usize]) -> (Vec<u8>, Vec<usize>) {
        self.functions(steps)
    }
}

impl X86 {
    fn arithmetic(&self, opcode: u8) -> Form {
        let prefix = match (self.shape.is_scalar(), self.shape.is_f64()) {
            (true, true) => 3,
            (true, false) => 2,
            (false, true) => 1,
            (false, false) => 0,
        };
        Form { map: 1, prefix, wide: self.is_evex() && self.shape.is_f64(), opcode }
    }

    fn bits(&self, of_f64: u8, of_f32: u8) -> Form {
        let opcode = if self.shape.is_f64() { of_f64 } else { of_f32 };
        Form { map: 1, prefix: 1, wide: self.is_evex() && self.shape.is_f64(), opcode }
    }

    fn product(&self, opcode: u8) -> Form {
        Form { map: 2, prefix: 1, wide: self.shape.is_f64(), opcode: opcode + u8::from(self.shape.is_scalar()) }
    }

    fn is_evex(&self) -> bool {
        self.shape.encoding() == Encoding::Evex
    }

    /// target ← ± (a · c) ± target, where c may be in memory.
    pub fn fused_231(&mut self, operation: Operation, target: Register, a: Register, c: Operand) {
        self.tally.count(operation);
        let form = self.product(0xb8 + fused_offset(operation));
        self.instruction(form, target, a, c);
    }

    /// target ← ± (a · target) ± c, where c may be in memory.
    pub fn fused_213(&mut self, operation: Operation, target: Register, a: Register, c: Operand) {
        self.tally.count(operation);
        let form = self.product(0xa8 + fused_offset(operation));
        self.instruction(form, target, a, c);
    }

    /// target ← ± (target · c) ± a, where c may be in memory.
    pub fn fused_132(&mut self, operation: Operation, target: Register, a: Register, c: Operand) {
        self.tally.count(operation);
        let form = self.product(0x98 + fused_offset(operation));
        self.instruction(form, target, a, c);
    }

    fn mask(&mut self, numbers: usize) -> Mask {
        let place = self.masks.iter().position(|&known| known == numbers).unwrap_or_else(|| {
            self.masks.push(numbers);
            self.masks.len() - 1
        });
        assert!(place < MOST_MASKS, "{} masks", self.masks.len());
        place as Mask + 1
    }

    fn instruction(&mut self, form: Form, target: Register, a: Register, b: Operand) {
        self.masked(form, target, a, b, 0);
    }

    fn masked(&mut self, form: Form, target: Register, a: Register, b: Operand, mask: Mask) {
        assert!(usize::from(target.max(a)) < self.shape.registers(), "no such register");
        self.tally.instructions += 1;
        let (base, repeated) = match b {
            Operand::Register(register) => {
                assert!(usize::from(register) < self.shape.registers(), "no such register");
                (register, false)
            }
            Operand::Lanes(memory, _) => (BASES[memory], false),
            // a broadcast is a separate instruction, without the broadcast bit
            Operand::Repeated(memory, _) => (BASES[memory], !form.is_broadcast()),
        };
        assert!(self.is_evex() || form.is_broadcast() || !repeated, "AVX2 repeats no operands");
        let is_register = matches!(b, Operand::Register(_));
        self.tally.loads += usize::from(!is_register && form.opcode != STORE);
        if self.is_evex() {
            self.evex(form, target, a, base, is_register, u8::from(repeated) << 4 | mask);
        } else {
            self.vex(form, target, a, base);
        }
        self.body.push(form.opcode);
        match b {
            Operand::Register(register) => self.body.push(0xc0 | (target & 7) << 3 | register & 7),
            Operand::Lanes(memory, byte) => {
                let numbers = if mask == 0 { self.shape.lanes() } else { self.masks[usize::from(mask) - 1] };
                self.address(target, memory, byte, self.shape.width(), byte + numbers * self.shape.number());
            }
            Operand::Repeated(memory, byte) => {
                self.address(target, memory, byte, self.shape.number(), byte + self.shape.number());
            }
        }
    }

    fn vex(&mut self, form: Form, target: Register, a: Register, base: u8) {
        let length = u8::from(!self.shape.is_scalar());
        let Form { map, prefix, wide, .. } = form;
        let last = (!a & 15) << 3 | length << 2 | prefix;
        if map == 1 && !wide && base < 8 {
            self.body.extend([0xc5, inverted(target, 3) << 7 | last]);
        } else {
            let registers = inverted(target, 3) << 7 | 1 << 6 | inverted(base, 3) << 5;
            self.body.extend([0xc4, registers | map, u8::from(wide) << 7 | last]);
        }
    }

    fn evex(&mut self, form: Form, target: Register, a: Register, base: u8, is_register: bool, modifiers: u8) {
        let Form { map, prefix, wide, .. } = form;
        // the fifth bit of a register operand is in the place of an address's index bit
        let x = if is_register { inverted(base, 4) } else { 1 };
        let registers = inverted(target, 3) << 7 | x << 6 | inverted(base, 3) << 5 | inverted(target, 4) << 4;
        let second = u8::from(wide) << 7 | (!a & 15) << 3 | 4 | prefix;
        // 512 bits, or the lowest number
        let length = if self.shape.is_scalar() { 0 } else { 2 };
        let third = length << 5 | modifiers | inverted(a, 4) << 3;
        self.body.extend([0x62, registers | map, second, third]);
    }

    /// An address with its displacement, for an access that ends before byte `end`; EVEX counts short displacements in
    /// units of the operand's size without a mask.
    fn address(&mut self, field: u8, memory: Memory, byte: usize, operand: usize, end: usize) {
        if memory == self.frame {
            self.sizes[memory] = self.sizes[memory].max(end);
        }
        assert!(end <= self.sizes[memory] && end <= i32::MAX as usize, "byte {byte} of array {memory}");
        let unit = if self.is_evex() { operand } else { 1 };
        let (field, base) = ((field & 7) << 3, BASES[memory] & 7);
        if byte.is_multiple_of(unit) && byte / unit < 128 {
            self.body.extend([0x40 | field | base, (byte / unit) as u8]);
        } else {
            self.body.push(0x80 | field | base);
            self.body.extend((byte as u32).to_le_bytes());
        }
    }
}

fn inverted(register: u8, bit: u8) -> u8 {
    !(register >> bit) & 1
}

fn fused_offset(operation: Operation) -> u8 {
    match operation {
        Operation::MulAdd => 0,
        Operation::MulSub => 2,
        Operation::NegMulAdd => 4,
        Operation::NegMulSub => 6,
        _ => unreachable!("not a fused product"),
    }
}
