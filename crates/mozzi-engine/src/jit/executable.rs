//! Executable memory with machine code, and calls into it: the only place in this crate with `unsafe`, and the argument
//! for its safety.
//!
//! The code comes from [`allocate`](super::allocate()) alone. Its assembler knows how many bytes each array has and
//! refuses an instruction that would read or write beyond one of them, so that a fault in its input (a wrong program, a
//! wrong register) gives wrong numbers, but never a wrong address. The parts to be trusted are the assembler's few
//! forms, each of which the tests compare with a disassembler, and its frame, which is on the stack and touched page by
//! page, or, if it is large, in memory of the calling thread. The code calls nothing, does not branch except back to
//! its beginning for the next run, and restores the callee-saved registers of the System V ABI, or of AAPCS64.
//!
//! Memory is writable while it is filled and executable afterwards, never both; constants are in pages of their own
//! that become read-only (`memmap2`, on every system). On macOS for AArch64 pages are for machine code from the
//! beginning, and writable or executable for each thread: for this one writable while they are filled.

use super::allocate::Code;
use super::rows::Extent;
use super::segments;
use super::shape::Shape;
use super::target::{LARGEST_ON_STACK, MOST_ARRAYS};
use memmap2::{Mmap, MmapMut};
use mozzi::scalar::Float;
use std::any::TypeId;
use std::cell::RefCell;

/// Machine code that can be called.
#[derive(Debug)]
pub(crate) struct Executable {
    code: Pages,
    /// Where its segments begin.
    starts: Vec<usize>,
    /// None if there are no constants.
    pool: Option<Mmap>,
    /// Inputs, then outputs.
    extents: Vec<Extent>,
    inputs: usize,
    shape: Shape,
    /// Bytes of the frame.
    frame: usize,
}

/// 64 bytes, aligned as the code expects its frame.
#[derive(Clone)]
#[repr(align(64))]
#[allow(dead_code)] // the code alone uses them
struct Aligned([u8; 64]);

thread_local! {
    /// The frame of code that is too large for the stack. It grows when it is first needed.
    static FRAME: RefCell<Vec<Aligned>> = const { RefCell::new(Vec::new()) };
}

/// The addresses of the arrays.
type Addresses = [*mut u8; MOST_ARRAYS];

impl Executable {
    /// None if the processor lacks the instructions, or the system grants no executable memory.
    pub fn new(shape: Shape, code: &Code, extents: Vec<Extent>, inputs: usize) -> Option<Self> {
        if !shape.is_supported() {
            return None;
        }
        let (starts, frame) = (code.starts.clone(), code.frame);
        let pool = if code.pool.is_empty() { None } else { Some(filled(&code.pool)?.make_read_only().ok()?) };
        let code = executable(&code.bytes)?;
        Some(Executable { code, starts, pool, extents, inputs, shape, frame })
    }

    pub fn extents(&self) -> &[Extent] {
        &self.extents
    }

    /// Computes all lanes, `runs` times, each time a step further in every array. The last output is a separate
    /// argument.
    ///
    /// # Panics
    /// If the numbers are of another type, an array is missing or too short, or the code cannot run so many times.
    #[inline(always)]
    pub fn call<S: Float>(&self, runs: usize, inputs: &[&[S]], outputs: &mut [&mut [S]], last: &mut [S]) {
        let mut addresses = [std::ptr::null_mut::<u8>(); MOST_ARRAYS];
        let arrays = inputs.len() + outputs.len() + 1;
        assert!(inputs.len() == self.inputs && arrays == self.extents.len(), "another number of arrays");
        assert!(runs == 1 || !self.shape.is_scalar() && runs > 0, "{runs} runs");
        let mut extents = self.extents.iter();
        for ((address, input), extent) in addresses.iter_mut().zip(inputs).zip(extents.by_ref().take(self.inputs)) {
            let length = extent.of(runs);
            assert!(input.len() >= length, "an input has {} entries, expected {length}", input.len());
            *address = input.as_ptr().cast_mut().cast();
        }
        for ((address, output), extent) in addresses[self.inputs..].iter_mut().zip(outputs).zip(extents.by_ref()) {
            let length = extent.of(runs);
            assert!(output.len() >= length, "an output has {} entries, expected {length}", output.len());
            *address = output.as_mut_ptr().cast();
        }
        self.run_with(runs, &mut addresses, last);
    }

    /// Runs with these addresses and that of the last output, whose type and length are checked here.
    #[inline(always)]
    fn run_with<S: Float>(&self, runs: usize, addresses: &mut Addresses, last: &mut [S]) {
        let number = if self.shape.is_f64() { TypeId::of::<f64>() } else { TypeId::of::<f32>() };
        assert!(TypeId::of::<S>() == number, "numbers of another type");
        let place = self.extents.len() - 1;
        assert!(last.len() >= self.extents[place].of(runs), "the last output has {} entries", last.len());
        addresses[place] = last.as_mut_ptr().cast();
        addresses[place + 1] = self.pool.as_ref().map_or(std::ptr::null_mut(), |pool| pool.as_ptr().cast_mut());
        let is_alone = self.starts.len() == 1 && self.frame <= LARGEST_ON_STACK;
        if is_alone { self.enter(0, runs, addresses) } else { self.run_beside(runs, addresses) }
    }

    /// Runs with a frame that is not on the stack; segment after segment, each on a group of runs.
    #[inline(never)]
    fn run_beside(&self, runs: usize, addresses: &mut Addresses) {
        let (frames, group) = match segments::group(self.shape) {
            _ if self.starts.len() == 1 => (1, runs),
            group => (group.min(runs), group),
        };
        FRAME.with_borrow_mut(|frame| {
            let lines = self.frame.div_ceil(64) * frames;
            if frame.len() < lines {
                frame.resize(lines, Aligned([0; 64]));
            }
            addresses[self.extents.len() + 1] = frame.as_mut_ptr().cast();
            for first in (0..runs).step_by(group) {
                let count = group.min(runs - first);
                self.starts.iter().for_each(|&start| self.enter(start, count, addresses));
                for (address, extent) in addresses.iter_mut().zip(&self.extents) {
                    *address = address.wrapping_add(count * extent.step * self.shape.number());
                }
            }
        });
    }

    /// Calls the function that begins at this offset.
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    #[inline(always)]
    fn enter(&self, start: usize, runs: usize, addresses: &Addresses) {
        #[cfg(target_arch = "x86_64")]
        type Function = extern "sysv64" fn(*const *mut u8, usize);
        #[cfg(target_arch = "aarch64")]
        type Function = extern "C" fn(*const *mut u8, usize);
        // SAFETY: a whole function of this signature begins there (each machine's `function.rs`), and the processor has
        // its instructions (`new`). It accesses only the arrays at the given addresses, each as long as the assembler
        // assumed for so many runs (checked by the callers; the outputs are borrowed exclusively), its constants, and
        // its frame, on its stack or borrowed by `run_beside`.
        unsafe {
            let function: Function = std::mem::transmute(self.code.as_ptr().wrapping_add(start));
            function(addresses.as_ptr(), runs);
        }
    }

    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    fn enter(&self, _: usize, _: usize, _: &Addresses) {
        unreachable!("no code was made");
    }
}

/// Pages of their own that begin with these bytes.
fn filled(bytes: &[u8]) -> Option<MmapMut> {
    let mut pages = MmapMut::map_anon(bytes.len()).ok()?;
    pages[..bytes.len()].copy_from_slice(bytes);
    Some(pages)
}

#[cfg(not(all(target_arch = "aarch64", target_os = "macos")))]
use Mmap as Pages;

/// Executable pages that begin with this code.
#[cfg(not(all(target_arch = "aarch64", target_os = "macos")))]
fn executable(code: &[u8]) -> Option<Pages> {
    let pages = filled(code)?.make_exec().ok()?;
    #[cfg(target_arch = "aarch64")]
    make_visible(&pages);
    Some(pages)
}

/// Writes this memory from the cache of data to where that of instructions reads, and empties the latter: an AArch64
/// does not do it by itself.
#[cfg(all(target_arch = "aarch64", not(target_os = "macos")))]
fn make_visible(code: &[u8]) {
    use std::arch::asm;
    let (start, end) = (code.as_ptr().addr(), code.as_ptr().addr() + code.len());
    // SAFETY: the instructions concern caches of this readable memory alone; Linux allows them to programs.
    unsafe {
        let sizes: usize;
        asm!("mrs {}, ctr_el0", out(reg) sizes, options(nomem, nostack, preserves_flags));
        let (data, instructions) = (4 << (sizes >> 16 & 15), 4 << (sizes & 15));
        for line in (start / data * data..end).step_by(data) {
            asm!("dc cvau, {}", in(reg) line, options(nostack, preserves_flags));
        }
        asm!("dsb ish", options(nostack, preserves_flags));
        for line in (start / instructions * instructions..end).step_by(instructions) {
            asm!("ic ivau, {}", in(reg) line, options(nostack, preserves_flags));
        }
        asm!("dsb ish", "isb", options(nostack, preserves_flags));
    }
}

#[cfg(all(target_arch = "aarch64", target_os = "macos"))]
use apple::{Pages, executable};

/// Apple's processors: pages are mapped for machine code, and each thread may either write to all such pages or run
/// them. A program with the hardened runtime needs the entitlement `com.apple.security.cs.allow-jit`.
#[cfg(all(target_arch = "aarch64", target_os = "macos"))]
mod apple {
    use std::ffi::c_void;

    #[derive(Debug)]
    pub struct Pages {
        start: *mut u8,
        length: usize,
    }

    // SAFETY: nothing writes to the pages once they are made, and only the owner unmaps them.
    unsafe impl Send for Pages {}
    // SAFETY: as above.
    unsafe impl Sync for Pages {}

    unsafe extern "C" {
        fn sys_icache_invalidate(start: *mut c_void, length: usize);
    }

    impl Pages {
        pub fn as_ptr(&self) -> *const u8 {
            self.start
        }
    }

    impl Drop for Pages {
        fn drop(&mut self) {
            // SAFETY: the whole mapping that `executable` made, which nothing borrows any more.
            unsafe { libc::munmap(self.start.cast(), self.length) };
        }
    }

    /// Executable pages that begin with this code; none if the system grants none.
    pub fn executable(code: &[u8]) -> Option<Pages> {
        let length = code.len();
        let access = libc::PROT_READ | libc::PROT_WRITE | libc::PROT_EXEC;
        let flags = libc::MAP_PRIVATE | libc::MAP_ANON | libc::MAP_JIT;
        // SAFETY: a mapping of its own, `length` bytes long; this thread writes to it, and does not run such pages
        // meanwhile; afterwards no thread writes to it.
        unsafe {
            let start = libc::mmap(std::ptr::null_mut(), length, access, flags, -1, 0);
            if start == libc::MAP_FAILED {
                return None;
            }
            let pages = Pages { start: start.cast(), length };
            libc::pthread_jit_write_protect_np(0);
            std::ptr::copy_nonoverlapping(code.as_ptr(), pages.start, length);
            libc::pthread_jit_write_protect_np(1);
            sys_icache_invalidate(start, length);
            Some(pages)
        }
    }
}
