//! Memory grows in proportion to the number of links, whatever the shape of the tree.
#![allow(clippy::unwrap_used)]

use mozzi_urdf::parse;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Bytes held by this thread, and their maximum.
struct Counting;
thread_local!(static HELD: Cell<[usize; 2]> = const { Cell::new([0, 0]) });

fn count(more: usize, less: usize) {
    let [held, most] = HELD.get();
    let held = (held + more).saturating_sub(less);
    HELD.set([held, most.max(held)]);
}

// SAFETY: forwards every call to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size(), 0);
        // SAFETY: the caller's contract.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // both may be held for a moment
        count(size, 0);
        count(0, layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.realloc(pointer, layout, size) }
    }
}
#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[path = "large/mod.rs"]
mod large;

/// The peak memory in bytes from text to model, without the text.
fn bytes(text: &str) -> usize {
    let [held, _] = HELD.get();
    HELD.set([held, held]);
    let robot = parse("large", text).unwrap();
    assert!(robot.warnings.is_empty());
    let model = robot.build().unwrap();
    assert!(model.n() > 100);
    drop(model);
    let [_, most] = HELD.get();
    most - held
}

#[test]
fn memory_is_linear_in_the_number_of_links() {
    for (name, robot) in large::ROBOTS {
        let [few, many] = [1_000, 10_000].map(|n| bytes(&robot(n)));
        println!("{name}: {} bytes a link of 1000, {} of 10000", few / 1_000, many / 10_000);
        // lists grow by doubling, so after doubling half of the capacity may be empty
        assert!(many < 16 * few, "{name}: {few} bytes for 1000 links, {many} for 10000");
    }
}
