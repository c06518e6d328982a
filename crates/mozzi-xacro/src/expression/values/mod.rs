//! Values, as Python has them.

pub(crate) mod dictionary;
pub(crate) mod float;
pub(crate) mod integer;
pub(crate) mod kinds;
pub(crate) mod reference;
pub(crate) mod repr;
pub(crate) mod value;
