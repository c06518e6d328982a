//! Errors, with the numbers that caused them.

use super::problem::{Problem, Severity};
use crate::spelling::nearest;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Write};

/// Errors of building a model and of its methods.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Error {
    /// The description is invalid, or contains something that mozzi does not support.
    Invalid {
        /// The robot's name.
        robot: String,
        /// All problems found.
        problems: Vec<Problem>,
    },
    /// The constraints cannot be satisfied.
    Unreachable {
        /// The constraint that is violated most.
        constraint: String,
        /// Its violation, rad or m, or their rates.
        residual: f64,
        /// The configuration or state that was searched for.
        what: &'static str,
    },
    /// The motors cannot produce the motion.
    Underactuated {
        /// The joint that takes the largest part of the missing force.
        joint: String,
        /// The missing force.
        force: f64,
        /// The number of motors.
        motors: usize,
        /// The degrees of freedom that the constraints leave.
        freedom: usize,
    },
    /// A vector or matrix of a wrong length.
    WrongLength {
        /// Which argument.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that the model requires.
        expected: usize,
    },
    /// No frame has this name.
    NoSuchFrame {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// No joint has this name.
    NoSuchJoint {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// No state has this name.
    NoSuchState {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// No quantity has this name.
    NoSuchQuantity {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<&'static str>,
    },
    /// The end effector is not obvious.
    NoEndEffector {
        /// The candidates.
        leaves: Vec<String>,
    },
    /// The mass matrix cannot be inverted: a joint moves no inertia, or joints produce the same motion.
    SingularMassMatrix {
        /// The joint.
        joint: String,
        /// Its pivot: the inertia that remains if all other joints are free.
        pivot: f64,
        /// Its inertia if all other joints are locked.
        diagonal: f64,
        /// The positions.
        theta: Vec<f64>,
    },
    /// The task's directions are not independent at this state.
    SingularTask {
        /// Singular values of the task's rows, largest first.
        singular_values: Vec<f64>,
        /// The bound.
        tolerance: f64,
        /// The positions.
        theta: Vec<f64>,
    },
    /// The moving links have no mass.
    NoMass {
        /// kg.
        mass: f64,
    },
    /// An argument outside its domain.
    BadArgument {
        /// Which argument.
        what: &'static str,
        /// Its value.
        found: String,
        /// The domain.
        expected: &'static str,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Invalid { robot, problems } => write!(f, "the robot `{robot}` cannot be built:{}", list(problems)),
            Error::Unreachable { constraint, residual, what } => write!(
                f,
                "constraint `{constraint}` cannot be satisfied: {what} does; the nearest violates it by {residual:.3e}"
            ),
            Error::Underactuated { joint, force, motors, freedom } => write!(
                f,
                "no motor drives `{joint}` ({motors} motors for {freedom} degrees of freedom): the motion needs {force:.3e} N m \
         or N there"
            ),
            Error::WrongLength { what, found, expected } => {
                write!(f, "{what} has {found} entries, expected {expected}")
            }
            Error::NoSuchFrame { name, known } => {
                write!(f, "there is no frame `{name}`{}; this robot has {}", meant(name, known), near(name, known))
            }
            Error::NoSuchJoint { name, known } => {
                write!(f, "there is no joint `{name}`{}; this robot has {}", meant(name, known), near(name, known))
            }
            Error::NoSuchState { name, known } => {
                write!(f, "there is no state `{name}`{}; this robot has {}", meant(name, known), near(name, known))
            }
            Error::NoSuchQuantity { name, known } => {
                let near = nearest(name, known, 3);
                write!(f, "there is no quantity `{name}`; the nearest of {} are {}", known.len(), names(&near))
            }
            Error::NoEndEffector { leaves } => {
                write!(f, "the end effector must be named: this robot ends in {}", first_names(leaves, 6))
            }
            Error::SingularMassMatrix { joint, pivot, diagonal, theta } => write!(
                f,
                "the mass matrix is singular at joint `{joint}`: its pivot is {pivot:e}, against {diagonal:e} on the diagonal (it moves no inertia, or \
         other joints produce the same motion), at θ = {}",
                short(theta)
            ),
            Error::SingularTask { singular_values, tolerance, theta } => write!(
                f,
                "the task is singular at θ = {}: the singular values of its Jacobian are {}, the smallest {:.1e}, below \
                 {tolerance:.1e}",
                short(theta),
                short(singular_values),
                singular_values.last().copied().unwrap_or_default()
            ),
            Error::NoMass { mass } => write!(f, "the robot's total mass is {mass} kg; the centre of mass is undefined"),
            Error::BadArgument { what, found, expected } => write!(f, "{what} is {found}, expected {expected}"),
        }
    }
}

impl core::error::Error for Error {}

fn list(problems: &[Problem]) -> String {
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error);
    errors.fold(String::new(), |mut text, problem| {
        // writing to a String cannot fail
        let _ = write!(text, "\n  {problem}");
        text
    })
}

/// At most twelve numbers with at most six decimals.
fn short(list: &[f64]) -> String {
    let mut text = String::from("[");
    for (k, x) in list.iter().take(SHOWN).enumerate() {
        let decimals = if x.abs() < 1e6 { format!("{x:.6}") } else { format!("{x:.3e}.") };
        let number = decimals.trim_end_matches('0').trim_end_matches('.');
        let _ = write!(text, "{}{}", if k == 0 { "" } else { ", " }, if number == "-0" { "0" } else { number });
    }
    if list.len() > SHOWN {
        text += ", …";
    }
    text + "]"
}

/// Further numbers of a list are left out of a message.
const SHOWN: usize = 12;

pub(crate) fn names<T: AsRef<str>>(names: &[T]) -> String {
    first_names(names, MOST_NAMES)
}

/// Names listed in a message.
const MOST_NAMES: usize = 20;

/// The only name that differs by its case alone, else the only one that contains the given name.
fn meant(name: &str, known: &[String]) -> String {
    let one = |is_near: &dyn Fn(&str) -> bool| {
        let mut near = known.iter().filter(|known| is_near(known));
        near.next().filter(|_| near.next().is_none())
    };
    let lower = name.to_lowercase();
    let found = one(&|known| known.to_lowercase() == lower)
        .or_else(|| one(&|known| lower.len() > 2 && known.to_lowercase().contains(&lower)));
    let found = found.filter(|_| known.len() > 1);
    found.map_or_else(String::new, |found| format!(" (did you mean `{found}`?)"))
}

/// All names, or of many the three nearest.
fn near(name: &str, known: &[String]) -> String {
    if known.len() <= MOST_NAMES {
        return names(known);
    }
    let list: Vec<&str> = known.iter().map(String::as_str).collect();
    format!("{}, the nearest of {}", names(&nearest(name, &list, 3)), known.len())
}

/// At most this many names; the others are counted.
fn first_names<T: AsRef<str>>(names: &[T], most: usize) -> String {
    let mut text = String::new();
    for (k, name) in names.iter().take(most).enumerate() {
        let _ = write!(text, "{}`{}`", if k == 0 { "" } else { ", " }, name.as_ref());
    }
    match names.len() {
        0 => text.push_str("none"),
        more if more > most => {
            let _ = write!(text, " and {} more", more - most);
        }
        _ => {}
    }
    text
}
