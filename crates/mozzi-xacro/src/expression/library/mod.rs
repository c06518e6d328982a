//! Functions and methods.

pub(crate) mod aggregate;
pub(crate) mod dict_methods;
pub(crate) mod function;
pub(crate) mod gamma;
pub(crate) mod list_methods;
pub(crate) mod math;
pub(crate) mod math_integer;
pub(crate) mod methods;
pub(crate) mod string_methods;
pub(crate) mod string_split;
pub(crate) mod template;
pub(crate) mod types;
