//! Builds only if mozzi and mozzi-sim, without their default features, need no `std`: see `xtask/src/no_std.rs`.
#![no_std]

use core::alloc::{GlobalAlloc, Layout};
use mozzi as _;
use mozzi_sim as _;

/// The library uses `alloc`, so there must be an allocator; nothing is ever run.
struct NoMemory;

// SAFETY: it gives no memory, so there is none to get wrong.
unsafe impl GlobalAlloc for NoMemory {
    unsafe fn alloc(&self, _: Layout) -> *mut u8 {
        core::ptr::null_mut()
    }
    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[global_allocator]
static NO_MEMORY: NoMemory = NoMemory;

/// `std` has one too: both together do not compile.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
