//! The timed computations, and their times.

use mozzi_batch::InstructionSet;

/// How a quantity is computed.
#[derive(Clone, Copy, PartialEq)]
pub struct Way {
    /// None: one state at a time.
    pub set: Option<InstructionSet>,
    pub precision: &'static str,
    pub threads: usize,
}

/// Nanoseconds per state, and the largest difference from one state, relative to the largest entry.
pub struct Timing {
    pub name: String,
    pub way: Way,
    pub least: f64,
    pub median: f64,
    pub difference: f64,
}

/// All times, and their conditions.
pub struct Report {
    pub processor: String,
    pub states: u32,
    pub rounds: u16,
    pub threads: usize,
    pub complete: bool,
    pub timings: Vec<Timing>,
}
