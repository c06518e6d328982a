//! Reports about a file: findings, their places, consequences and remedies.

pub(crate) mod consequence;
pub(crate) mod diagnostic;
pub(crate) mod error;
pub(crate) mod explain;
pub(crate) mod finding;
pub(crate) mod placed;
pub(crate) mod places;
#[cfg(feature = "pretty")]
pub(crate) mod pretty;
pub(crate) mod problem;
pub(crate) mod repair;
pub(crate) mod spelling;
pub(crate) mod visible;
pub(crate) mod why;
