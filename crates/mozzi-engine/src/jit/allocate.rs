//! Register allocation for straight-line code: the value whose next use is furthest away is evicted first (Belady
//! 1966). With equal costs this is optimal.

use super::instruction::{Node, Operation, SINES, Value};
use super::lower::{Lowered, Store};
use super::operand::{Operand, Register};
use super::places::{Places, put_constants};
use super::registers::{NEVER, Pinned, Registers};
use super::rows::Extent;
use super::shape::{Encoding, Shape};
use super::target::{Assembler, LARGEST_FRAME, MOST_ARRAYS, Tally};
use super::{Form, Refusal};
use std::cell::Cell;

/// Machine code with its constants, before it is placed in executable memory.
#[derive(Clone, Debug)]
pub(crate) struct Code {
    pub bytes: Vec<u8>,
    /// Where its segments begin, each a function.
    pub starts: Vec<usize>,
    /// The constants.
    pub pool: Vec<u8>,
    pub tally: Tally,
    pub frame: usize,
}

/// How the code of a program uses the caller's arrays.
pub(crate) struct Arrays<'a> {
    /// Inputs, then outputs.
    pub extents: &'a [Extent],
    pub inputs: usize,
    pub form: Form,
    /// The bytes after which a segment ends.
    pub segment: usize,
}

/// The code of a lowered program; its arrays are inputs, outputs, constants, in this order. Fails if it needs more
/// arrays, or more memory of its own, than the limits.
pub(crate) fn allocate<A: Assembler>(shape: Shape, lowered: &Lowered, arrays: Arrays) -> Result<Code, Refusal> {
    let (mut pool, together) = (Vec::new(), shape.together());
    let before = lowered.before.as_deref().map(|before| (before, put_constants(together, before, &mut pool)));
    let constants = put_constants(shape, lowered, &mut pool);
    let mut sizes: Vec<usize> = arrays.extents.iter().map(|extent| extent.size * shape.number()).collect();
    sizes.push(pool.len());
    if sizes.len() >= MOST_ARRAYS {
        return Err(Refusal::Program);
    }
    if sizes.iter().any(|&size| size >= A::LARGEST_ARRAY) {
        return Err(Refusal::Long);
    }
    let memory = sizes.len() - 1;
    let mut assembler = A::new(shape, &sizes);
    let mut used = 0;
    if let Some((before, constants)) = before {
        // its results are at the beginning of the frame
        used = before.outputs[0].len() * together.width();
        let (first_output, stride, segment) = (assembler.frame(), shape.number(), usize::MAX);
        let places = Places { constants, pool: memory, first_output, stride, used, segment };
        assembler.set_shape(together);
        assembler = Line::new(together, before, places, assembler).code();
        assembler.set_shape(shape);
    }
    let stride = if arrays.form == Form::Rows { shape.number() } else { shape.width() };
    // code for one state runs once
    let extents = if shape.is_scalar() { &[] } else { arrays.extents };
    let steps: Vec<usize> = extents.iter().map(|extent| extent.step * shape.number()).collect();
    let Arrays { inputs: first_output, segment, .. } = arrays;
    let places = Places { constants, pool: memory, first_output, stride, used, segment };
    let mut assembler = Line::new(shape, lowered, places, assembler).code();
    let (tally, frame) = (*assembler.tally(), assembler.frame_bytes());
    if frame > LARGEST_FRAME {
        return Err(Refusal::Long);
    }
    let (bytes, starts) = assembler.finish(&steps);
    Ok(Code { bytes, starts, pool, tally, frame })
}

pub(crate) struct Line<'p, A> {
    pub shape: Shape,
    nodes: &'p [Node],
    places: Places,
    pub assembler: A,
    /// For each value v, the places that need it: `needs[first[v]..first[v + 1]]`; those before `next[v]` are past.
    needs: Vec<u32>,
    first: Vec<u32>,
    next: Vec<u32>,
    /// For each value, where it is written.
    outputs: Vec<Vec<Store>>,
    pub register: Vec<Option<Register>>,
    registers: Registers,
    slot: Vec<Option<usize>>,
    free_slots: Vec<usize>,
    slots: usize,
    /// Stores that were narrower than a register, without a mask.
    narrow: usize,
    /// Stores and loads of slots.
    spills: Cell<usize>,
}

impl<'p, A: Assembler> Line<'p, A> {
    fn new(shape: Shape, lowered: &'p Lowered, places: Places, assembler: A) -> Self {
        let nodes = &lowered.nodes[..];
        let mut outputs = vec![Vec::new(); nodes.len()];
        let mut is_needed = vec![false; nodes.len()];
        let entry = |array: usize, (index, &value): (usize, &Value)| Store {
            value,
            array,
            byte: index * shape.width(),
            numbers: shape.lanes(),
        };
        let entries =
            lowered.outputs.iter().enumerate().flat_map(|(k, list)| list.iter().enumerate().map(move |x| entry(k, x)));
        for store in entries.chain(lowered.stores.iter().copied()) {
            let array = places.first_output + store.array;
            outputs[store.value as usize].push(Store { array, ..store });
            is_needed[store.value as usize] = true;
        }
        // values that nothing needs are never computed
        for place in (0..nodes.len()).rev() {
            if is_needed[place] {
                nodes[place].operands().iter().for_each(|&operand| is_needed[operand as usize] = true);
            }
        }
        let mut first = vec![0; nodes.len() + 1];
        let needed = || nodes.iter().enumerate().filter(|(place, _)| is_needed[*place]);
        for (_, node) in needed() {
            node.operands().iter().for_each(|&operand| first[operand as usize + 1] += 1);
        }
        for place in 0..nodes.len() {
            first[place + 1] += first[place];
        }
        let (mut needs, mut fill) = (vec![0; first[nodes.len()] as usize], first.clone());
        for (place, node) in needed() {
            for &operand in node.operands() {
                needs[fill[operand as usize] as usize] = place as u32;
                fill[operand as usize] += 1;
            }
        }
        Line {
            shape,
            nodes,
            slots: places.used / shape.width(),
            places,
            assembler,
            needs,
            next: first[..nodes.len()].to_vec(),
            first,
            outputs,
            register: vec![None; nodes.len()],
            registers: Registers::new(shape.registers(), shape.further()),
            slot: vec![None; nodes.len()],
            free_slots: Vec::new(),
            narrow: 0,
            spills: Cell::new(0),
        }
    }

    /// The assembler with the whole code.
    fn code(mut self) -> A {
        for place in 0..self.nodes.len() {
            self.step(place);
            // without masks, a narrow row's store is right once the next row is stored: so all of the square, or none
            let is_between_squares = self.narrow.is_multiple_of(self.shape.lanes());
            if self.assembler.segment_bytes() >= self.places.segment && is_between_squares {
                self.cut();
            }
        }
        self.assembler.tally().spills += self.spills.get();
        self.assembler
    }

    /// Puts all registers aside and begins another segment.
    fn cut(&mut self) {
        for (register, value) in self.registers.held() {
            self.put_aside(register, value);
        }
        self.assembler.cut();
    }

    /// The next place that needs a value.
    fn next_need(&self, value: Value) -> u32 {
        let (next, end) = (self.next[value as usize], self.first[value as usize + 1]);
        if next < end { self.needs[next as usize] } else { NEVER }
    }

    /// The memory of a value that is in no register.
    pub fn in_memory(&self, value: Value) -> Operand {
        let width = self.shape.width();
        match (self.nodes[value as usize], self.slot[value as usize]) {
            (Node::Constant(_), _) => {
                let (pool, byte) = (self.places.pool, self.places.constants[value as usize]);
                if self.shape.repeats() { Operand::Repeated(pool, byte) } else { Operand::Lanes(pool, byte) }
            }
            (Node::Input(SINES, index), _) => Operand::Lanes(self.assembler.frame(), index as usize * width),
            (Node::Input(array, index), _) => Operand::Lanes(array as usize, index as usize * self.places.stride),
            (_, Some(slot)) => {
                self.spills.set(self.spills.get() + 1);
                Operand::Lanes(self.assembler.frame(), slot * width)
            }
            (_, None) => unreachable!("value {value} was lost"),
        }
    }

    /// The value's register, or its memory.
    pub fn operand(&self, value: Value) -> Operand {
        self.register[value as usize].map_or_else(|| self.in_memory(value), Operand::Register)
    }

    /// A register for a new value: a free one, or the one whose value is needed last; values that need not be stored
    /// are preferred.
    pub fn take(&mut self, here: usize, pinned: &mut Pinned) -> Register {
        let (register, evicted) = self.registers.choose(here, *pinned);
        if let Some(value) = evicted {
            self.put_aside(register, value);
        }
        *pinned |= 1 << register;
        register
    }

    /// Frees a register; its value is stored unless it is in memory.
    fn put_aside(&mut self, register: Register, value: Value) {
        let v = value as usize;
        self.registers.release(register);
        self.register[v] = None;
        if matches!(self.nodes[v], Node::Apply(..)) && self.slot[v].is_none() {
            let slot = self.free_slots.pop().unwrap_or_else(|| {
                self.slots += 1;
                self.slots - 1
            });
            self.slot[v] = Some(slot);
            self.spills.set(self.spills.get() + 1);
            self.assembler.store(self.assembler.frame(), slot * self.shape.width(), register);
        }
    }

    /// Puts the value in a register; a loaded value stays there if it is needed again.
    pub fn in_register(&mut self, here: usize, value: Value, pinned: &mut Pinned) -> Register {
        if let Some(register) = self.register[value as usize] {
            return register;
        }
        let (from, register) = (self.in_memory(value), self.take(here, pinned));
        self.assembler.load(register, from);
        if self.next_need(value) != NEVER {
            self.hold(register, value);
        }
        register
    }

    fn hold(&mut self, register: Register, value: Value) {
        let is_kept = self.slot[value as usize].is_some() || !matches!(self.nodes[value as usize], Node::Apply(..));
        self.registers.hold(register, value, self.next_need(value), is_kept);
        self.register[value as usize] = Some(register);
    }

    /// The register of a value that is no longer needed.
    pub fn dying(&self, value: Value) -> Option<Register> {
        self.register[value as usize].filter(|_| self.next_need(value) == NEVER)
    }

    fn step(&mut self, here: usize) {
        let value = here as Value;
        let Node::Apply(operation, operands) = self.nodes[here] else {
            self.pass_on(here, value);
            return;
        };
        if self.next_need(value) == NEVER && self.outputs[here].is_empty() {
            return;
        }
        let operands = &operands[..operation.arity()];
        let mut pinned = 0;
        for &v in operands {
            while self.next_need(v) <= value {
                self.next[v as usize] += 1;
            }
            if let Some(register) = self.register[v as usize] {
                pinned |= 1 << register;
                self.registers.set_need(register, self.next_need(v));
            }
        }
        let target = match *operands {
            [a] => self.unary(here, operation, a, &mut pinned),
            [a, b] => self.binary(here, operation, a, b, &mut pinned),
            [a, b, c] => A::fused(self, here, (operation, [a, b, c]), &mut pinned),
            _ => unreachable!("one to three operands"),
        };
        for &v in operands {
            if self.next_need(v) == NEVER {
                if let Some(register) = self.register[v as usize].take() {
                    self.registers.release(register);
                }
                self.free_slots.extend(self.slot[v as usize].take());
            }
        }
        for &Store { array, byte, numbers, .. } in &self.outputs[here] {
            self.assembler.store_part(array, byte, target, numbers);
            self.narrow += usize::from(numbers < self.shape.lanes() && self.shape.encoding() == Encoding::Vex);
        }
        if self.next_need(value) != NEVER {
            self.hold(target, value);
        }
    }

    /// Writes an output that is an input or a constant.
    fn pass_on(&mut self, here: usize, value: Value) {
        for k in 0..self.outputs[here].len() {
            let register = self.take(here, &mut 0);
            self.assembler.load(register, self.in_memory(value));
            let Store { array, byte, numbers, .. } = self.outputs[here][k];
            self.assembler.store_part(array, byte, register, numbers);
        }
    }

    fn unary(&mut self, here: usize, operation: Operation, a: Value, pinned: &mut Pinned) -> Register {
        let from = self.in_register(here, a, pinned);
        let target = self.dying(a).unwrap_or_else(|| self.take(here, pinned));
        self.assembler.apply(operation, target, from, Operand::Register(from));
        target
    }

    fn binary(&mut self, here: usize, operation: Operation, a: Value, b: Value, pinned: &mut Pinned) -> Register {
        let is_in_register = |line: &Self, v: Value| line.register[v as usize].is_some();
        let exchange = operation.commutes() && !is_in_register(self, a) && is_in_register(self, b);
        let (a, b) = if exchange { (b, a) } else { (a, b) };
        let first = self.in_register(here, a, pinned);
        let second = match self.assembler.takes_memory(operation) {
            true => self.operand(b),
            false if a == b => Operand::Register(first),
            false => Operand::Register(self.in_register(here, b, pinned)),
        };
        let was_loaded = self.register[a as usize].is_none().then_some(first);
        let target = self.dying(a).or(self.dying(b)).or(was_loaded).unwrap_or_else(|| self.take(here, pinned));
        self.assembler.apply(operation, target, first, second);
        target
    }
}
