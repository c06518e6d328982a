//! The timed computations, and their times.

/// How a quantity is computed.
#[derive(Clone, Copy, PartialEq)]
pub struct Way {
    /// One state in a call, or all.
    pub is_one: bool,
    pub precision: &'static str,
    pub threads: usize,
}

impl Way {
    /// Its column.
    pub fn title(self) -> String {
        if self.is_one { "one state".to_string() } else { format!("arrays {}", self.precision) }
    }
}

/// Nanoseconds per state, and the largest difference from one state, relative to the largest entry.
pub struct Timing {
    pub name: String,
    /// The engine that computed the quantity.
    pub engine: String,
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
