//! Expressions: a bounded part of Python, evaluated as Python does.

mod comprehension;
mod evaluate;
mod library;
mod operations;
mod syntax;
mod values;

pub(crate) use evaluate::evaluate;
pub(crate) use library::function::global;
pub(crate) use operations::host::Host;
pub(crate) use syntax::names::{KEYWORDS, begins_name, continues_name};
pub(crate) use syntax::{Node, parse};
pub(crate) use values::float::parse as parse_float;
pub(crate) use values::integer::parse as parse_int;
pub(crate) use values::kinds::as_float as float_of;
pub(crate) use values::repr::{short, text_of};
pub(crate) use values::value::Dictionary;
pub(crate) use values::value::Value;
