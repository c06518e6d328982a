//! Executable memory with machine code, and calls into it: the only place in this crate with `unsafe`, and the argument
//! for its safety.
//!
//! The code comes from [`allocate`](super::allocate()) alone. Its assembler knows how many bytes each array has and
//! refuses an instruction that would read or write beyond one of them, so that a fault in its input (a wrong program, a
//! wrong register) gives wrong numbers, but never a wrong address. The parts to be trusted are the assembler's few
//! forms, each of which the tests compare with a disassembler, and its frame, which is on the stack and touched page by
//! page. The code calls nothing, does not branch, and restores the callee-saved registers of the System V ABI.
//!
//! Memory is writable while it is filled and executable afterwards, never both; constants are in pages of their own
//! that become read-only.

use super::allocate::Code;
use super::assembler::MOST_ARRAYS;
use super::shape::Shape;
use mozzi::scalar::Float;
use std::any::TypeId;

/// Machine code that can be called.
#[derive(Debug)]
pub(crate) struct Executable {
    pages: Pages,
    /// The offset of the constants, after the code.
    pool: usize,
    /// Inputs, then outputs.
    lengths: Vec<usize>,
    inputs: usize,
    shape: Shape,
}

impl Executable {
    /// None if the processor lacks the instructions, or the system grants no executable memory.
    pub fn new(shape: Shape, code: &Code, inputs: &[usize], outputs: &[usize]) -> Option<Self> {
        if !shape.is_supported() {
            return None;
        }
        let (pages, pool) = Pages::new(&code.bytes, &code.pool)?;
        Some(Executable { pages, pool, lengths: [inputs, outputs].concat(), inputs: inputs.len(), shape })
    }

    /// Computes all lanes: the lanes of entry k of an array are at `k · lanes`. The last output is a separate argument.
    ///
    /// # Panics
    /// If the numbers are of another type, or an array is missing or too short.
    #[inline(always)]
    pub fn call<S: Float>(&self, inputs: &[&[S]], outputs: &mut [&mut [S]], last: &mut [S]) {
        let lanes = self.shape.lanes();
        let mut addresses = [std::ptr::null_mut::<u8>(); MOST_ARRAYS];
        let arrays = inputs.len() + outputs.len() + 1;
        assert!(inputs.len() == self.inputs && arrays == self.lengths.len(), "another number of arrays");
        let mut lengths = self.lengths.iter();
        for ((address, input), length) in addresses.iter_mut().zip(inputs).zip(lengths.by_ref().take(self.inputs)) {
            assert!(input.len() >= length * lanes, "an input has {} entries, expected {length}", input.len());
            *address = input.as_ptr().cast_mut().cast();
        }
        for ((address, output), length) in addresses[self.inputs..].iter_mut().zip(outputs).zip(lengths.by_ref()) {
            assert!(output.len() >= length * lanes, "an output has {} entries, expected {length}", output.len());
            *address = output.as_mut_ptr().cast();
        }
        self.run_with(addresses, last);
    }

    /// As [`call`](Self::call), with inputs and outputs each in one slice, array after array.
    ///
    /// # Panics
    /// If the numbers are of another type, or a slice is too short.
    #[inline(always)]
    pub fn call_joined<S: Float>(&self, inputs: &[S], outputs: &mut [S], last: &mut [S]) {
        let lanes = self.shape.lanes();
        let mut addresses = [std::ptr::null_mut::<u8>(); MOST_ARRAYS];
        let (given, found) = self.lengths.split_at(self.inputs);
        let found = &found[..found.len() - 1]; // the last is an argument of its own
        let mut at = 0;
        for (address, length) in addresses.iter_mut().zip(given) {
            let array = &inputs[at..at + length * lanes];
            (*address, at) = (array.as_ptr().cast_mut().cast(), at + array.len());
        }
        let mut rest = outputs;
        for (address, length) in addresses[self.inputs..].iter_mut().zip(found) {
            let (array, further) = rest.split_at_mut(length * lanes);
            (*address, rest) = (array.as_mut_ptr().cast(), further);
        }
        self.run_with(addresses, last);
    }

    /// Runs with these addresses and that of the last output, whose type and length are checked here.
    #[inline(always)]
    fn run_with<S: Float>(&self, mut addresses: [*mut u8; MOST_ARRAYS], last: &mut [S]) {
        let number = if self.shape.is_f64() { TypeId::of::<f64>() } else { TypeId::of::<f32>() };
        assert!(TypeId::of::<S>() == number, "numbers of another type");
        let place = self.lengths.len() - 1;
        let length = self.lengths[place] * self.shape.lanes();
        assert!(last.len() >= length, "the last output has {} entries", last.len());
        addresses[place] = last.as_mut_ptr().cast();
        self.run(&mut addresses);
    }

    #[cfg(all(unix, target_arch = "x86_64"))]
    #[inline(always)]
    fn run(&self, addresses: &mut [*mut u8; MOST_ARRAYS]) {
        addresses[self.lengths.len()] = self.pages.start.wrapping_add(self.pool);
        // SAFETY: the pages begin with a whole function of this signature (`Assembler::finish`), and the processor has
        // its instructions (`new`). It accesses only the arrays at the given addresses, each as long as the assembler
        // assumed (checked by the callers; the outputs are borrowed exclusively), its constants, and its stack.
        unsafe {
            let function: extern "sysv64" fn(*const *mut u8) = std::mem::transmute(self.pages.start);
            function(addresses.as_ptr());
        }
    }

    #[cfg(not(all(unix, target_arch = "x86_64")))]
    fn run(&self, _: &mut [*mut u8; MOST_ARRAYS]) {
        unreachable!("no code was made");
    }
}

/// Pages of code, and pages of constants after them.
#[derive(Debug)]
struct Pages {
    start: *mut u8,
    length: usize,
}

// SAFETY: the pages are immutable once made, and are not bound to a thread.
unsafe impl Send for Pages {}
// SAFETY: likewise.
unsafe impl Sync for Pages {}

#[cfg(all(unix, target_arch = "x86_64"))]
impl Pages {
    /// Makes the pages; returns them and the offset of the constants.
    fn new(code: &[u8], constants: &[u8]) -> Option<(Self, usize)> {
        const PAGE: usize = 4096; // of x86-64
        let pool = code.len().next_multiple_of(PAGE);
        let length = pool + constants.len().next_multiple_of(PAGE);
        // SAFETY: a new private mapping, at an address that the system chooses, aliases nothing.
        let start = unsafe {
            let access = libc::PROT_READ | libc::PROT_WRITE;
            libc::mmap(std::ptr::null_mut(), length, access, libc::MAP_PRIVATE | libc::MAP_ANON, -1, 0)
        };
        if start == libc::MAP_FAILED {
            return None;
        }
        let pages = Pages { start: start.cast(), length };
        // SAFETY: the mapping is `length` bytes long, writable, and not shared yet; code and constants fit in their
        // parts. Neither part is written again: the first becomes executable, the second read-only.
        let is_granted = unsafe {
            std::ptr::copy_nonoverlapping(code.as_ptr(), pages.start, code.len());
            std::ptr::copy_nonoverlapping(constants.as_ptr(), pages.start.add(pool), constants.len());
            libc::mprotect(start, pool, libc::PROT_READ | libc::PROT_EXEC) == 0
                && (length == pool || libc::mprotect(pages.start.add(pool).cast(), length - pool, libc::PROT_READ) == 0)
        };
        is_granted.then_some((pages, pool))
    }
}

#[cfg(not(all(unix, target_arch = "x86_64")))]
impl Pages {
    fn new(_: &[u8], _: &[u8]) -> Option<(Self, usize)> {
        None
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        #[cfg(all(unix, target_arch = "x86_64"))]
        // SAFETY: this value owns the mapping, and no call is running: a call borrows it.
        unsafe {
            libc::munmap(self.start.cast(), self.length);
        }
    }
}
