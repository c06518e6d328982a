//! Operators, comparisons, indices and formats.

pub(crate) mod arguments;
pub(crate) mod compare;
pub(crate) mod context;
pub(crate) mod format;
pub(crate) mod host;
pub(crate) mod index;
pub(crate) mod iterate;
pub(crate) mod operators;
pub(crate) mod percent;
