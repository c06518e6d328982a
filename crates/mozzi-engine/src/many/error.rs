//! Errors of batches.

use crate::Shape;

/// Errors of batches. An error names the first state that failed; no state is skipped silently.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A table of a wrong length.
    #[error("{what} has {found} numbers, expected {expected} ({states} states of {width})")]
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
    },
    /// The first table, such as θ, is not a whole number of states.
    #[error("{what} has {found} numbers, expected a multiple of {width}: {width} numbers a state")]
    IncompleteState {
        /// The table's name: the first table.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Numbers for each state.
        width: usize,
    },
    /// A state that could not be computed.
    #[error("state {index} (counted from 0): {source}")]
    State {
        /// Its index.
        index: usize,
        /// The reason; that of a quantity is a [`mozzi_sim::Error::Model`].
        source: mozzi_sim::Error,
    },
    /// An error that concerns all states.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
    /// An error of a simulation that concerns all states.
    #[error(transparent)]
    Simulation(#[from] mozzi_sim::Error),
    /// Not a shape of machine code for several states of this number type, or not of this processor.
    #[error("machine code of {} for {} states at once is not for these numbers, or not for this processor", shape.instruction_set(), shape.lanes())]
    Shape {
        /// The requested one.
        shape: Shape,
    },
    /// Threads could not be started.
    #[error("{threads} threads could not be started: {reason}")]
    Threads {
        /// The requested number of threads.
        threads: usize,
        /// The reason: the system's error, or the expected number of threads.
        reason: String,
    },
}

impl Error {
    /// The error of the first state that failed, of those of all chunks.
    pub(crate) fn of_first(errors: Vec<Vec<(usize, mozzi::Error)>>) -> Result<(), Self> {
        match errors.into_iter().flatten().min_by_key(|(index, _)| *index) {
            Some((index, source)) => Err(Error::State { index, source: source.into() }),
            None => Ok(()),
        }
    }

    /// Adds `first` to the index of the state.
    pub(crate) fn after(self, first: usize) -> Self {
        match self {
            Error::State { index, source } => Error::State { index: first + index, source },
            other => other,
        }
    }
}
