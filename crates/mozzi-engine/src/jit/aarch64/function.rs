//! The function around the code: it saves the caller's registers, makes its frame, takes the arrays' addresses, and
//! runs the code in a loop, whose number of passes is an argument.

use super::encode::add_immediate;
use super::{Address, Arm, FIRST_BASE};
use crate::jit::target::{Assembler, segments, with_frame};

const LIST: Address = 0;
const COUNTER: Address = 1;
const STACK: Address = 31;
/// The stack's guard is at least so far away.
const PAGE: usize = 4096;

/// `bti c`: where an indirect call may enter; elsewhere it does nothing.
const ENTRANCE: u32 = 0xd503_245f;
const RETURN: u32 = 0xd65f_03c0;
const INVALID: u32 = 0;

impl Arm {
    /// The function of each segment: x0 → an array of addresses, x1 runs (AAPCS64). It keeps no return address: the
    /// link register stays as it is.
    pub fn functions(mut self, steps: &[usize]) -> (Vec<u8>, Vec<usize>) {
        let (steps, is_on_stack) = with_frame(&mut self.sizes, &self.cuts, steps);
        let (mut code, mut starts) = (Vec::new(), Vec::new());
        for body in segments(&self.body, &self.cuts) {
            code.resize(code.len().next_multiple_of(16), INVALID);
            starts.push(4 * code.len());
            self.function(&mut code, body, &steps, is_on_stack);
        }
        (code.into_iter().flat_map(u32::to_le_bytes).collect(), starts)
    }

    fn function(&self, code: &mut Vec<u32>, body: &[u32], steps: &[usize], is_on_stack: bool) {
        // v8 to v15, of which a function keeps the lower halves, in pairs
        let saved = || (8..16_u32).step_by(2).filter(|pair| self.used >> pair & 3 != 0).zip(0..);
        let room = 16 * saved().count();
        let frame = if is_on_stack { self.frame_bytes().next_multiple_of(16) } else { 0 };
        code.push(ENTRANCE);
        code.extend(subtract(room));
        code.extend(saved().map(|(pair, place)| pair_at(0x6d00_0000, pair, place)));
        // page by page, so that the guard page below the stack is touched and not skipped
        for _ in 0..frame / PAGE {
            code.extend(subtract(PAGE));
            code.push(0xf900_03ff); // str xzr, [sp]
        }
        code.extend(subtract(frame % PAGE));
        let given = if is_on_stack { self.frame } else { self.sizes.len() };
        for memory in 0..given {
            // ldr base, [x0, 8 memory]
            code.push(0xf940_0000 | (memory as u32) << 10 | u32::from(LIST) << 5 | base(memory));
        }
        if is_on_stack {
            code.extend(moved(base(self.frame) as Address, STACK, 0));
        }
        let begin = code.len();
        code.extend(body);
        if !steps.is_empty() {
            for (memory, &step) in steps.iter().enumerate().filter(|(_, step)| **step > 0) {
                let base = base(memory) as Address;
                code.extend(moved(base, base, step));
            }
            code.push(0xf100_0400 | u32::from(COUNTER) << 5 | u32::from(COUNTER)); // subs x1, x1, 1; b.ne begin
            let back = code.len() - begin;
            assert!(back < 1 << 18, "{back} instructions are beyond a branch");
            code.push(0x5400_0001 | (back as u32).wrapping_neg() << 5 & 0x00ff_ffe0);
        }
        code.extend(moved(STACK, STACK, frame).filter(|_| frame > 0));
        code.extend(saved().map(|(pair, place)| pair_at(0x6d40_0000, pair, place)));
        code.extend(moved(STACK, STACK, room).filter(|_| room > 0));
        code.push(RETURN);
    }
}

fn base(memory: usize) -> u32 {
    u32::from(FIRST_BASE) + memory as u32
}

/// target ← from + by.
fn moved(target: Address, from: Address, by: usize) -> impl Iterator<Item = u32> {
    let from = std::iter::once(from).chain(std::iter::repeat(target));
    add_immediate(target, by).zip(from).map(|(word, from)| word | u32::from(from) << 5)
}

/// sub sp, sp, by; nothing for 0.
fn subtract(by: usize) -> Option<u32> {
    let (shift, by) = if by == PAGE { (1 << 22, 1) } else { (0, by as u32) };
    (by > 0).then_some(0xd100_03ff | shift | by << 10)
}

/// `stp` or `ldp` of the lower halves of two registers, at this place of 16 bytes on the stack.
fn pair_at(word: u32, first: u32, place: u32) -> u32 {
    word | (2 * place) << 15 | (first + 1) << 10 | u32::from(STACK) << 5 | first
}
