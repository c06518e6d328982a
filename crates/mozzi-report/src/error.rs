//! Why there is no page.

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A column of the motion has the wrong length.
    #[error("the motion {}, expected {expected}: {rows} rows of {width}", numbers(what, *found))]
    Motion {
        /// The column: `theta`, `tau`, …
        what: &'static str,
        /// Numbers in it.
        found: usize,
        /// The expected count of numbers.
        expected: usize,
        /// Times.
        rows: usize,
        /// Numbers per row.
        width: usize,
    },
    /// A force of a contact that does not exist.
    #[error("the motion has a force of contact {pair}, expected fewer than {all} contacts")]
    Contact {
        /// The pair of a contact point and a plane, from 0.
        pair: usize,
        /// The number of pairs.
        all: usize,
    },
    /// The times of the motion decrease, or one is not a number.
    #[error("the motion's time is {t} s in row {row}, expected times that do not decrease")]
    Time {
        /// The row, from 1.
        row: usize,
        /// Its time, s.
        t: f64,
    },
    /// An error of mozzi at a state.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
}

fn numbers(what: &str, found: usize) -> String {
    if found == 0 { format!("has no {what}") } else { format!("has {found} numbers of {what}") }
}
