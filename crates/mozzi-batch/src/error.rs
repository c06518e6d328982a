//! Errors of batches.

use crate::InstructionSet;

/// Errors of batches. An error names the first state that failed; no state is skipped silently.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A table of a wrong length.
    #[error("{what} has {found} numbers, expected {expected} ({states} states of {width}{})", padded(*lanes))]
    WrongLength {
        /// The table's name.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that matches θ's.
        expected: usize,
        /// The number of states, from θ.
        states: usize,
        /// Numbers for each state.
        width: usize,
        /// States in a block if the layout is in blocks; else 1.
        lanes: usize,
    },
    /// The first table, such as θ, is not a whole number of states.
    #[error("{what} has {found} numbers, expected a multiple of {width}: {width} numbers a state{}", padded(*lanes))]
    IncompleteState {
        /// The table's name: the first table.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Numbers for each state.
        width: usize,
        /// States in a block if the layout is in blocks; else 1.
        lanes: usize,
    },
    /// A state that could not be computed.
    #[error("state {index} (counted from 0): {source}")]
    State {
        /// Its index.
        index: usize,
        /// The reason.
        source: mozzi::Error,
    },
    /// An error that concerns all states.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
    /// The machine does not have these registers.
    #[error("this machine has no {}; it has {}", set.name(), names())]
    UnsupportedInstructionSet {
        /// The requested name.
        set: InstructionSet,
    },
    /// Threads could not be started.
    #[error("{threads} threads could not be started: {reason}")]
    Threads {
        /// The requested number of threads.
        threads: usize,
        /// What was expected.
        reason: String,
    },
}

impl Error {
    /// The same error, its state's index counted from `first` on.
    pub(crate) fn after(self, first: usize) -> Self {
        match self {
            Error::State { index, source } => Error::State { index: first + index, source },
            other => other,
        }
    }
}

fn padded(lanes: usize) -> String {
    if lanes == 1 { String::new() } else { format!(", in whole blocks of {lanes} states") }
}

fn names() -> String {
    InstructionSet::available().iter().map(|set| set.name()).collect::<Vec<_>>().join(", ")
}
