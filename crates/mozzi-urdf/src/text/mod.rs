//! From bytes to elements: encoding, xacro, XML, and the places of everything.

pub(crate) mod bytes;
pub(crate) mod context;
pub(crate) mod dialect;
pub(crate) mod element;
pub(crate) mod expansion;
pub(crate) mod mend;
pub(crate) mod number;
pub(crate) mod pages;
pub(crate) mod scan;
pub(crate) mod source;
pub(crate) mod syntax;
pub(crate) mod version;
pub(crate) mod xacro;
