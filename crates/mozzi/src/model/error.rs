//! What can go wrong with a robot, with the numbers.

use super::check::{Problem, Severity};
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

/// Why a model could not be built or asked.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The description contradicts itself, or describes what mozzi cannot compute.
    #[error("the robot `{robot}` cannot be built:{}", list(problems))]
    Invalid {
        /// The robot's name.
        robot: String,
        /// All that was found.
        problems: Vec<Problem>,
    },
    /// A vector or matrix of a wrong length.
    #[error("{what} has {found} entries, expected {expected}")]
    WrongLength {
        /// Which argument.
        what: &'static str,
        /// Its length.
        found: usize,
        /// What the model needs.
        expected: usize,
    },
    /// No frame has this name.
    #[error("there is no frame `{name}`; this robot has {}", names(known))]
    NoSuchFrame {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// No joint has this name.
    #[error("there is no joint `{name}`; this robot has {}", names(known))]
    NoSuchJoint {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// No quantity has this name.
    #[error("there is no quantity `{name}`; expected one of {}", all_names(known))]
    NoSuchQuantity {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<&'static str>,
    },
    /// The end effector is not obvious.
    #[error("the end effector has to be named: this robot ends in {}", names(leaves))]
    NoEndEffector {
        /// The candidates.
        leaves: Vec<String>,
    },
    /// The mass matrix cannot be inverted: something massless can move freely.
    #[error(
        "the mass matrix is singular at joint `{joint}`: its pivot is {pivot:e}, against {diagonal:e} on the diagonal (what it moves has no \
         inertia, or the joint's motion is that of others), at θ = {theta:?}"
    )]
    SingularMassMatrix {
        /// The joint.
        joint: String,
        /// What is left of its inertia when all others are free.
        pivot: f64,
        /// Its inertia when all others are locked.
        diagonal: f64,
        /// The positions.
        theta: Vec<f64>,
    },
    /// The task's directions cannot be moved independently here.
    #[error(
        "the task is singular at θ = {theta:?}: the singular values of its Jacobian are {singular_values:?}, the smallest below {tolerance:e}"
    )]
    SingularTask {
        /// Of the rows asked for, largest first.
        singular_values: Vec<f64>,
        /// The bound.
        tolerance: f64,
        /// The positions.
        theta: Vec<f64>,
    },
    /// A simulated state leaves the numbers.
    #[error(
        "the simulation blew up: {quantity} of joint `{joint}` is {value:e} in step {step}, at t = {time} s, with steps of {step_size} s; \
         a smaller step may help"
    )]
    Diverged {
        /// "theta", "dtheta" or "ddtheta".
        quantity: &'static str,
        /// The joint.
        joint: String,
        /// Infinite, NaN, or so large (10¹⁵⁰) that energies are.
        value: f64,
        /// Steps are counted from 1; 0 is the start.
        step: usize,
        /// Seconds.
        time: f64,
        /// Seconds.
        step_size: f64,
    },
    /// Nothing that moves has mass.
    #[error("the robot's total mass is {mass} kg; the centre of mass is undefined")]
    NoMass {
        /// kg.
        mass: f64,
    },
    /// An argument outside its domain.
    #[error("{what} is {found}, expected {expected}")]
    BadArgument {
        /// Which argument.
        what: &'static str,
        /// Its value.
        found: String,
        /// The domain.
        expected: &'static str,
    },
}

fn list(problems: &[Problem]) -> String {
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error);
    errors.fold(String::new(), |mut text, problem| {
        // writing to a String cannot fail
        let _ = write!(text, "\n  {problem}");
        text
    })
}

fn all_names(names: &[&str]) -> String {
    names.join(", ")
}

pub(crate) fn names<T: AsRef<str>>(names: &[T]) -> String {
    let mut text = String::new();
    for (k, name) in names.iter().take(20).enumerate() {
        let _ = write!(text, "{}`{}`", if k == 0 { "" } else { ", " }, name.as_ref());
    }
    match names.len() {
        0 => text.push_str("none"),
        more if more > 20 => {
            let _ = write!(text, " and {} more", more - 20);
        }
        _ => {}
    }
    text
}
