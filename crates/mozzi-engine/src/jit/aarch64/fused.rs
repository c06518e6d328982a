//! Operations on three values, all in registers.

use super::Arm;
use crate::jit::allocate::Line;
use crate::jit::instruction::{Operation, Value};
use crate::jit::operand::Register;
use crate::jit::registers::Pinned;

impl Line<'_, Arm> {
    /// A result takes the place of an operand that is no longer needed. With several lanes, a fused product must be
    /// where its summand is, or where a copy of it is.
    pub fn of_three(
        &mut self,
        here: usize,
        (operation, [a, b, c]): (Operation, [Value; 3]),
        pinned: &mut Pinned,
    ) -> Register {
        let of_a = self.in_register(here, a, pinned);
        let of_b = if b == a { of_a } else { self.in_register(here, b, pinned) };
        let of_c = match c {
            _ if c == a => of_a,
            _ if c == b => of_b,
            _ => self.in_register(here, c, pinned),
        };
        let registers = [of_a, of_b, of_c];
        match operation {
            Operation::Select => self.select(here, [a, b, c], registers, pinned),
            _ if self.shape.is_scalar() => {
                let free = [c, a, b].into_iter().zip([registers[2], registers[0], registers[1]]);
                let free = free.into_iter().find(|&(value, register)| self.is_free(value, register));
                let target = free.map_or_else(|| self.take(here, pinned), |(_, register)| register);
                self.assembler.product_of_one(operation, target, registers);
                target
            }
            _ => {
                let [a, b, _] = registers;
                let target = self.copied(here, c, registers[2], pinned);
                self.assembler.product_of_lanes(operation, target, [a, b]);
                target
            }
        }
    }

    /// b where a is set, else c.
    fn select(
        &mut self,
        here: usize,
        [_, b, c]: [Value; 3],
        [odd, of_b, of_c]: [Register; 3],
        pinned: &mut Pinned,
    ) -> Register {
        if self.is_free(b, of_b) && !self.is_free(c, of_c) {
            self.assembler.insert(false, of_b, of_c, odd);
            return of_b;
        }
        let target = self.copied(here, c, of_c, pinned);
        self.assembler.insert(true, target, of_b, odd);
        target
    }

    /// True if the register of this operand holds nothing that is needed later.
    fn is_free(&self, value: Value, register: Register) -> bool {
        match self.register[value as usize] {
            Some(_) => self.dying(value) == Some(register),
            None => true, // loaded for this operation alone
        }
    }

    /// The operand's register if it is free, else another with a copy.
    fn copied(&mut self, here: usize, value: Value, from: Register, pinned: &mut Pinned) -> Register {
        if self.is_free(value, from) {
            return from;
        }
        let target = self.take(here, pinned);
        self.assembler.copy(target, from);
        target
    }
}
