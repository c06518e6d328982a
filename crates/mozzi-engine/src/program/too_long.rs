//! The bound on recordings.

use std::fmt;

/// A recording had more than [`MOST_STEPS`](TooLong::MOST_STEPS) steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLong;

impl TooLong {
    /// The largest number of steps, whose recording takes [`MOST_MEGABYTES`](Self::MOST_MEGABYTES).
    pub const MOST_STEPS: usize = 4_000_000;

    /// Memory of a recording of that length, in megabytes.
    pub const MOST_MEGABYTES: usize = 500;
}

impl fmt::Display for TooLong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (steps, memory) = (Self::MOST_STEPS, Self::MOST_MEGABYTES);
        write!(f, "longer than {steps} steps, which take {memory} MB")
    }
}

impl std::error::Error for TooLong {}
