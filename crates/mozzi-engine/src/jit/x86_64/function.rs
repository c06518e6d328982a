//! The function around the code: it saves the caller's registers, takes the arrays' addresses, makes its frame, and
//! runs the code in a loop, whose number of passes is an argument.

use super::{BASES, X86};
use crate::jit::target::{Assembler, segments, with_frame};

/// The index of the first register of [`BASES`] that must be saved for the caller.
const SAVED: usize = 9;
/// r12 counts the runs.
const COUNTER: u8 = 12;

impl X86 {
    /// The function of each segment, one after the other, with the places where they begin: rdi → an array of addresses
    /// (System V). With steps in bytes, it runs rsi ≥ 1 times, each array's address a step further every time. Several
    /// segments have a frame for each run, with the last address; a single one has one, on the stack if it is small.
    pub fn functions(mut self, steps: &[usize]) -> (Vec<u8>, Vec<usize>) {
        let (steps, is_on_stack) = with_frame(&mut self.sizes, &self.cuts, steps);
        let (mut code, mut starts) = (Vec::new(), Vec::new());
        for body in segments(&self.body, &self.cuts) {
            code.resize(code.len().next_multiple_of(64), 0xcc);
            starts.push(code.len());
            self.function(&mut code, body, &steps, is_on_stack);
        }
        (code, starts)
    }

    fn function(&self, code: &mut Vec<u8>, body: &[u8], steps: &[usize], is_on_stack: bool) {
        let (arrays, frame) = (self.sizes.len(), self.frame_bytes());
        code.extend([0x55, 0x48, 0x89, 0xe5]); // push rbp; mov rbp, rsp
        let counter = if steps.is_empty() { None } else { Some(COUNTER) };
        let saved = BASES[SAVED.min(arrays)..arrays].iter().copied().chain(counter);
        for register in saved.clone() {
            push_or_pop(code, 0x50, register);
        }
        let rest = if is_on_stack { (frame + 64).next_multiple_of(64) } else { 0 };
        // page by page, so that the guard page below the stack is touched and not skipped
        for _ in 0..rest / 4096 {
            code.extend([0x48, 0x81, 0xec, 0x00, 0x10, 0x00, 0x00]); // sub rsp, 4096
            code.extend([0x48, 0x85, 0x24, 0x24]); // test [rsp], rsp
        }
        code.extend([0x48, 0x81, 0xec]); // sub rsp, rest
        code.extend(((rest % 4096) as u32).to_le_bytes());
        if counter.is_some() {
            code.extend([0x49, 0x89, 0xf4]); // mov r12, rsi
        }
        for (k, numbers) in self.masks.iter().enumerate() {
            code.push(0xb8); // mov eax, 2^numbers − 1; kmovw k, eax
            code.extend(((1_u32 << numbers) - 1).to_le_bytes());
            code.extend([0xc5, 0xf8, 0x92, 0xc0 | (k as u8 + 1) << 3]);
        }
        // the frame's base: lea base, [rsp + 63]; and base, −64
        let is_rdi = |memory: usize| BASES[memory] == 7;
        let base = BASES[self.frame];
        let frame_base = |code: &mut Vec<u8>| {
            let (high, low) = (base >> 3, base & 7);
            code.extend([0x48 | high << 2, 0x8d, 0x44 | low << 3, 0x24, 63]);
            code.extend([0x48 | high, 0x83, 0xe0 | low, 0xc0]);
        };
        let address = |code: &mut Vec<u8>, memory: usize| {
            // mov base, [rdi + 8 memory]
            let base = BASES[memory];
            code.extend([0x48 | base >> 3 << 2, 0x8b, 0x47 | (base & 7) << 3, 8 * memory as u8]);
        };
        let given = if is_on_stack { 0..self.frame } else { 0..arrays };
        given.clone().filter(|&memory| !is_rdi(memory)).for_each(|memory| address(code, memory));
        given.filter(|&memory| is_rdi(memory)).for_each(|memory| address(code, memory));
        if is_on_stack {
            frame_base(code);
        }
        let begin = code.len();
        code.extend(body);
        if counter.is_some() {
            for (memory, &step) in steps.iter().enumerate().filter(|(_, step)| **step > 0) {
                // add base, step
                let base = BASES[memory];
                code.extend([0x48 | base >> 3, 0x81, 0xc0 | base & 7]);
                code.extend((step as u32).to_le_bytes());
            }
            code.extend([0x49, 0xff, 0xcc, 0x0f, 0x85]); // dec r12; jnz begin
            let end = code.len() + 4;
            code.extend((begin as i32 - end as i32).to_le_bytes());
        }
        // lea rsp, [rbp − 8 saved]; pop …; pop rbp; vzeroupper; ret
        code.extend([0x48, 0x8d, 0x65, (-8 * saved.clone().count() as i32) as u8]);
        for register in saved.collect::<Vec<_>>().into_iter().rev() {
            push_or_pop(code, 0x58, register);
        }
        code.extend([0x5d, 0xc5, 0xf8, 0x77, 0xc3]);
    }
}

fn push_or_pop(code: &mut Vec<u8>, opcode: u8, register: u8) {
    if register >= 8 {
        code.push(0x41);
    }
    code.push(opcode | register & 7);
}
