//! Errors of every quantity in every way, and of other libraries, against the same kernels on numbers of 31 and 71
//! digits. The command is `cargo xtask accuracy`, its result docs/accuracy.md.
//!
//! **The unit of an error.** One unit is the largest change of a result when each of the robot's constants and of the
//! rates is changed by ε = 2⁻⁵² of itself, and each angle by ε radians, up or down at random (the largest of [`DRAWS`]
//! draws), and no less than ε times the result. That is ε times the size of the terms, found without knowing the
//! formula: for ab − cd it is about ε times √2 of (|ab| + |cd|), even if the difference is small. For `f32` ε is 2⁻²³.

pub mod digits;
pub mod errors;
pub mod hard;
pub mod measure;
pub mod mixed;
pub mod page;
pub mod peers;
pub mod reference;
pub mod robot;
pub mod states;
pub mod terms;
pub mod ways;

/// The number of random perturbations of the constants that determine a unit.
pub const DRAWS: usize = 3;
