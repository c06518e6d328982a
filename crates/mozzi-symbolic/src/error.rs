//! Why there is no derivation.

use crate::read::NotRead;
use std::fmt;

/// Longer entries are not derived: a person reads none of them, and grouping takes longer and longer.
pub(crate) const LONGEST: usize = 30_000;
/// The terms of all entries together.
pub(crate) const LONGEST_IN_ALL: usize = 200_000;
/// The velocities of a robot whose mass matrix is inverted.
pub(crate) const MOST_VELOCITIES: usize = 4;
/// The moving links of a robot whose equations are derived.
pub(crate) const MOST_LINKS: usize = 1000;

/// The reason against quantities that divide and are not written as fractions.
pub(crate) const DIVIDES: &str = "divides by pivots";

/// The reason why there is no derivation.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Error {
    /// The second reader does not read the file.
    NotRead(NotRead),
    /// mozzi's own error.
    Model(mozzi::Error),
    /// The quantity is no polynomial in sines and parameters.
    NotPolynomial {
        /// The quantity.
        quantity: &'static str,
        /// The operation of its kernel that has no polynomial result.
        what: String,
    },
    /// The inverse of a matrix of so many velocities is too long.
    InverseTooLong {
        /// The quantity.
        quantity: &'static str,
        /// The robot's velocities.
        velocities: usize,
    },
    /// A matrix has no inverse at any configuration.
    Singular {
        /// The quantity.
        quantity: &'static str,
        /// The matrix, the reason, and a remedy.
        what: String,
    },
    /// The robot has no recursion in the book's form.
    NoRecursion(String),
    /// The robot has so many moving links.
    TooManyLinks(usize),
    /// The expressions would be too long.
    TooLong {
        /// The quantity.
        quantity: &'static str,
        /// The terms of an entry, of all entries, or on the way to them.
        terms: usize,
        /// The most that there may be.
        most: usize,
    },
    /// An expression differs from the kernel: an error of this library.
    NotProven {
        /// The quantity.
        quantity: &'static str,
        /// The entry.
        entry: usize,
        /// The difference that was found.
        what: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::NotRead(error) => write!(f, "the file's decimals: {error}"),
            Error::Model(error) => error.fmt(f),
            Error::NotPolynomial { quantity, what } => {
                let quantity = quantity.replace('_', "-");
                write!(f, "{quantity} {what}: it is no sum of products of sines and parameters")?;
                if what != DIVIDES {
                    return Ok(()); // this robot's is not derived, others' are
                }
                f.write_str(
                    ". Derived are quantities without an inverse, such as mass-matrix, velocity-product, \
                     gravity-forces and inverse-dynamics, and of those with one mass-matrix-inverse, \
                     forward-dynamics, task-space-dynamics and constrained-forward-dynamics",
                )
            }
            Error::InverseTooLong { quantity, velocities } => {
                let quantity = quantity.replace('_', "-");
                write!(
                    f,
                    "{quantity} of {velocities} velocities is too long to read as one fraction, expected at most \
                     {MOST_VELOCITIES}. Derive mass-matrix and bias-forces as sympy and solve with numbers, or lock joints"
                )
            }
            Error::Singular { quantity, what } => {
                write!(f, "{} is not derived: {what}", quantity.replace('_', "-"))
            }
            Error::NoRecursion(what) => write!(
                f,
                "the recursion is printed for joints that slide, or turn about an axis of their link, on a fixed base; \
                 the robot has {what}"
            ),
            Error::TooManyLinks(links) => {
                write!(
                    f,
                    "the robot has {links} moving links, expected at most {MOST_LINKS} of one whose equations are derived"
                )
            }
            Error::TooLong { quantity, terms, most } => {
                let quantity = quantity.replace('_', "-");
                write!(
                    f,
                    "{quantity} would have sums of {terms} terms, expected at most {most}. Numbers instead of symbols \
                     are shorter (symbols: none), and so are robots with locked joints"
                )
            }
            Error::NotProven { quantity, entry, what } => {
                write!(f, "entry {entry} of {quantity} is not proven, and is not printed: {what}. Please report this")
            }
        }
    }
}
impl std::error::Error for Error {}

impl From<mozzi::Error> for Error {
    fn from(error: mozzi::Error) -> Self {
        Error::Model(error)
    }
}
