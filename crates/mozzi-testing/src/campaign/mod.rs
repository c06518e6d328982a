//! Random robots, each a function of one seed, with every quantity compared between two ways of computing it. The
//! command is `cargo xtask campaign`, its summary docs/campaign.md.
//!
//! **The unit of an error.** As in [`accuracy`](crate::accuracy), one unit is the largest change of an output when the
//! robot's constants, the state and the environment change by ε = 2⁻⁵² of themselves (a zero and an angle by ε), up or
//! down at random, here computed in `f64`, so that the kernel's own rounding is in it; and no less than ε times the
//! output's largest entry. For quantities that divide, ε κ times the largest entry is added: κ is the condition of what
//! they divide by, see [`condition`]. A difference above [`LIMIT`] units is a finding.

pub mod case;
pub mod command;
pub mod condition;
pub mod emitted;
pub mod generate;
mod log;
pub mod page;
mod parts;
pub mod progress;
mod run;
pub mod shrink;
pub mod trial;

pub use log::{Counts, Finding, Way};
pub use run::{CODED, LONG, SECONDS, one, replay};

/// Largest allowed difference, in units.
pub const LIMIT: f64 = 1000.0;
