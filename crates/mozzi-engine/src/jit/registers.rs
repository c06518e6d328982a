//! The contents of the registers, and the choice of the one that is freed for a new value.

use super::instruction::Value;
use super::operand::Register;

/// The need of a value that nothing needs any more.
pub(crate) const NEVER: u32 = u32::MAX;

/// The most registers of a shape.
const MOST: usize = 32;

/// Registers that an instruction uses, as bits: they keep what they hold.
pub(crate) type Pinned = u32;

/// Arrays by register; those of a free one mean nothing.
pub(crate) struct Registers {
    count: usize,
    free: u32,
    value: [Value; MOST],
    /// The next place that needs the value.
    need: [u32; MOST],
    /// The value is in memory, too.
    is_kept: [bool; MOST],
    /// How much further away, in halves, the need of a value that is in memory may seem.
    further: u64,
}

impl Registers {
    /// So many, all free.
    pub fn new(count: usize, further: u64) -> Self {
        let free = ((1_u64 << count) - 1) as u32;
        Registers { count, free, value: [0; MOST], need: [0; MOST], is_kept: [false; MOST], further }
    }

    pub fn hold(&mut self, register: Register, value: Value, need: u32, is_kept: bool) {
        let place = usize::from(register);
        self.free &= !(1 << place);
        (self.value[place], self.need[place], self.is_kept[place]) = (value, need, is_kept);
    }

    pub fn set_need(&mut self, register: Register, need: u32) {
        self.need[usize::from(register)] = need;
    }

    pub fn release(&mut self, register: Register) {
        self.free |= 1 << register;
    }

    /// The registers that hold a value, with it.
    pub fn held(&self) -> Vec<(Register, Value)> {
        let is_held = |register: &usize| self.free >> register & 1 == 0;
        (0..self.count).filter(is_held).map(|register| (register as Register, self.value[register])).collect()
    }

    /// A free register, or the one whose value is needed last, with this value; values that need not be stored are
    /// preferred.
    pub fn choose(&self, here: usize, pinned: Pinned) -> (Register, Option<Value>) {
        let free = self.free & !pinned;
        if free != 0 {
            return (free.trailing_zeros() as Register, None);
        }
        // the largest of score · MOST + (MOST − 1 − place), without branches: of equal ones the first
        let mut best = None;
        for place in 0..self.count {
            let need = self.need[place];
            let away = u64::from(need.saturating_sub(here as u32));
            let bonus = if self.is_kept[place] { away * self.further / 2 } else { 0 };
            let score = u64::from(need) + bonus;
            let key = score * MOST as u64 + (MOST - 1 - place) as u64;
            best = best.max((pinned >> place & 1 == 0).then_some(key));
        }
        let place = MOST - 1 - best.expect("at most four registers are pinned") as usize % MOST;
        (place as Register, Some(self.value[place]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_ones_first_then_what_is_needed_last() {
        let mut registers = Registers::new(3, 1);
        assert_eq!(registers.choose(0, 0b001), (1, None));
        registers.hold(0, 10, 8, false);
        registers.hold(1, 11, 20, false);
        registers.hold(2, 12, 16, true);
        // 16 + (16 − 4) / 2 = 22 > 20: it need not be stored
        assert_eq!(registers.choose(4, 0), (2, Some(12)));
        assert_eq!(registers.choose(4, 0b100), (1, Some(11)));
        registers.set_need(0, NEVER);
        assert_eq!(registers.choose(4, 0), (0, Some(10)));
        registers.release(1);
        assert_eq!(registers.choose(4, 0), (1, None));
    }
}
