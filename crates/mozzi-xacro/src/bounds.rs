//! Bounds on time, memory and depth. Each ends the expansion with an error.

use crate::fault::{Fault, Result};
use std::cell::Cell;

/// The largest size of a file and of an expansion.
pub(crate) const MOST_BYTES: usize = 64 << 20;
/// The largest total of evaluation steps, elements and sixteenths of text: about half a second.
pub(crate) const MOST_WORK: u64 = 2_000_000;
/// Bytes of one string.
pub(crate) const MOST_TEXT: usize = 1 << 20;
/// Items of one list, dictionary or range that is iterated.
pub(crate) const MOST_ITEMS: usize = 1 << 18;
/// Bits of an int.
pub(crate) const MOST_BITS: u64 = 16_384;
/// Digits of an int that is read or printed, as in Python.
pub(crate) const MOST_DIGITS: usize = 4300;
/// Levels of one expression, and operators in a row.
pub(crate) const MOST_EXPRESSION_DEPTH: usize = 200;
/// Nesting depth of macros, elements, properties and parts of expressions.
pub(crate) const MOST_DEPTH: usize = 2000;
/// Macros in macros.
pub(crate) const MOST_CALLS: usize = 250;
/// Included files.
pub(crate) const MOST_FILES: usize = 4096;
/// Files in files.
pub(crate) const MOST_INCLUDE_DEPTH: usize = 100;
/// Levels of elements in a file.
pub(crate) const MOST_ELEMENT_DEPTH: usize = 256;
/// The stack needed for these depths.
pub(crate) const STACK: usize = 256 << 20;

/// The amounts used so far.
#[derive(Default)]
pub(crate) struct Budget {
    work: Cell<u64>,
    depth: Cell<usize>,
}

impl Budget {
    #[inline]
    pub fn spend(&self, work: u64) -> Result<()> {
        let total = self.work.get().saturating_add(work);
        self.work.set(total);
        if total > MOST_WORK {
            return Err(Fault::new(format!("the expansion takes more than {MOST_WORK} steps")));
        }
        Ok(())
    }

    /// Counts a new string of this many bytes.
    pub fn text(&self, bytes: usize) -> Result<()> {
        if bytes > MOST_TEXT {
            return Err(Fault::new(format!("a string of {bytes} bytes, expected at most {MOST_TEXT}")));
        }
        self.spend(1 + bytes as u64 / 16)
    }

    /// Counts a new collection of this many items.
    pub fn items(&self, count: usize) -> Result<()> {
        if count > MOST_ITEMS {
            return Err(Fault::new(format!("{count} items, expected at most {MOST_ITEMS}")));
        }
        self.spend(1 + count as u64)
    }

    pub fn work(&self) -> u64 {
        self.work.get()
    }

    /// Calls a function one level deeper.
    #[inline]
    pub fn deeper<T>(&self, what: impl FnOnce() -> Result<T>) -> Result<T> {
        let depth = self.depth.get();
        if depth >= MOST_DEPTH {
            return Err(Fault::new(format!("more than {MOST_DEPTH} levels of macros, properties and expressions")));
        }
        self.depth.set(depth + 1);
        let done = what();
        self.depth.set(depth);
        done
    }
}
