//! Fused multiply-adds, whose three forms overwrite one operand each and read another from memory.

use super::X86;
use crate::jit::allocate::Line;
use crate::jit::instruction::{Operation, Value};
use crate::jit::operand::{Operand, Register};
use crate::jit::registers::Pinned;
use crate::jit::target::Assembler;

impl Line<'_, X86> {
    /// ± a b ± c overwrites one of its operands: one that is no longer needed, or a copy.
    pub fn fused(
        &mut self,
        here: usize,
        (operation, [a, b, c]): (Operation, [Value; 3]),
        pinned: &mut Pinned,
    ) -> Register {
        let is_in_register = |line: &Self, v: Value| line.register[v as usize].is_some();
        if let Some(target) = self.dying(c) {
            let (a, b) = if is_in_register(self, a) { (a, b) } else { (b, a) };
            let first = self.in_register(here, a, pinned);
            self.assembler.fused_231(operation, target, first, self.operand(b));
            return target;
        }
        // a factor that is no longer needed, or that must be loaded anyway
        let (a, b) = if self.dying(a).is_some() || self.dying(b).is_none() && !is_in_register(self, a) {
            (a, b)
        } else {
            (b, a)
        };
        if self.dying(a).is_some() || !is_in_register(self, a) && is_in_register(self, c) {
            let target = match self.dying(a) {
                Some(register) => register,
                None => {
                    let (from, register) = (self.in_memory(a), self.take(here, pinned));
                    self.assembler.load(register, from);
                    register
                }
            };
            if a == b {
                self.assembler.fused_213(operation, target, target, self.operand(c));
            } else if is_in_register(self, c) && !is_in_register(self, b) {
                let third = self.operand(c);
                let Operand::Register(third) = third else { unreachable!("in a register") };
                self.assembler.fused_132(operation, target, third, self.operand(b));
            } else {
                let second = self.in_register(here, b, pinned);
                self.assembler.fused_213(operation, target, second, self.operand(c));
            }
            return target;
        }
        let (a, b) = if is_in_register(self, a) { (a, b) } else { (b, a) };
        let first = self.in_register(here, a, pinned);
        let (from, target) = (self.operand(c), self.take(here, pinned));
        self.assembler.load(target, from);
        self.assembler.fused_231(operation, target, first, self.operand(b));
        target
    }
}
