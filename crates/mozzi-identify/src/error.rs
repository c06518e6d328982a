//! Errors of logs and options.

use crate::{Finding, Level};

/// Why nothing was identified.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A column has a wrong length.
    #[error("{log}: {what} has {found} numbers, expected {expected}")]
    WrongLength {
        /// The log's name.
        log: String,
        /// The table, such as `tau`.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The expected length, as text: "rows × joints = number".
        expected: String,
    },
    /// Time does not increase.
    #[error("{log}: t is {found} s at row {row} (counted from 0) after {before} s, expected increasing times: {why}")]
    NotMonotonic {
        /// The log's name.
        log: String,
        /// The row.
        row: usize,
        /// The time there.
        found: f64,
        /// The time of the row before.
        before: f64,
        /// The likely cause, and the remedy.
        why: String,
    },
    /// Too many rows are not numbers.
    #[error(
        "{log}: {count} of {rows} rows contain NaN or infinite numbers, first `{column}` at row {row} \
         (counted from 0), \
         expected at most 5 %"
    )]
    NotFinite {
        /// The log's name.
        log: String,
        /// The first column that is not finite.
        column: String,
        /// Its row.
        row: usize,
        /// The number of such rows.
        count: usize,
        /// The number of rows.
        rows: usize,
    },
    /// The log is too short.
    #[error("{log}: {found} usable rows ({why}), expected at least {expected}")]
    TooShort {
        /// The log's name.
        log: String,
        /// The number of rows that can be used.
        found: usize,
        /// The number that is needed.
        expected: usize,
        /// The reason why rows are lost.
        why: String,
    },
    /// The log contradicts itself or the robot.
    #[error("{}; --trust-log fits such a log all the same", .faults.join("; also "))]
    Fault {
        /// Each fault, its place, and the remedy.
        faults: Vec<String>,
    },
    /// The times of the rows are not known.
    #[error("{}", .0.join("; also "))]
    Clock(Vec<String>),
    /// The motion determines nothing.
    #[error("the motion does not excite the robot: {reason}; move every joint, or use `mozzi excite`")]
    NotExciting {
        /// The missing excitation.
        reason: String,
    },
    /// An option has a wrong value.
    #[error("{option} is {found}, expected {expected}")]
    BadOption {
        /// The option's name.
        option: &'static str,
        /// Its value.
        found: String,
        /// The expected value.
        expected: String,
    },
    /// The convex problem has no solution within the constraints.
    #[error("the constraints contradict each other: {what}")]
    Infeasible {
        /// The constraint that cannot be satisfied.
        what: String,
    },
    /// The result cannot be a robot.
    #[error(transparent)]
    Model(#[from] mozzi::Error),
    /// A simulation of the robot.
    #[error(transparent)]
    Simulation(#[from] mozzi_sim::Error),
}

impl Error {
    /// The faults among findings.
    pub(crate) fn of_faults(findings: &[Finding]) -> Self {
        Error::Fault { faults: faults(findings) }
    }

    /// The faults among findings, if the times are not known: nothing can be fitted.
    pub(crate) fn of_clock(findings: &[Finding]) -> Self {
        Error::Clock(faults(findings))
    }
}

fn faults(findings: &[Finding]) -> Vec<String> {
    let faults = findings.iter().filter(|finding| finding.level == Level::Fault);
    faults.map(|finding| format!("{} ({})", finding.text, finding.code)).collect()
}
