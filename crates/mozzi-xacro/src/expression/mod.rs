//! Expressions: a bounded part of Python, evaluated as Python does.

mod aggregate;
mod arguments;
mod atoms;
mod compare;
mod comprehension;
mod dict_methods;
mod dictionary;
mod evaluate;
mod float;
mod format;
mod function;
mod gamma;
mod index;
mod integer;
mod iterate;
mod list_methods;
mod literal;
mod math;
mod math_integer;
mod methods;
mod operators;
mod parser;
mod percent;
mod repr;
mod string_methods;
mod string_split;
mod syntax;
mod template;
mod token;
mod types;
mod value;

pub(crate) use dictionary::Dictionary;
pub(crate) use evaluate::Evaluator;
pub(crate) use float::parse as parse_float;
pub(crate) use function::global;
pub(crate) use integer::parse as parse_int;
pub(crate) use operators::as_float as float_of;
pub(crate) use parser::parse;
pub(crate) use repr::{short, text_of};
pub(crate) use syntax::Node;
pub(crate) use token::{KEYWORDS, begins_name, continues_name};
pub(crate) use value::Value;

use crate::bounds::Budget;
use crate::fault::Result;
use crate::scope::Scope;
use std::rc::Rc;

/// The names of the surrounding expansion that an expression can use.
pub(crate) trait Host {
    fn budget(&self) -> &Budget;
    /// The value of a name; `is_nested` inside comprehensions and lambdas.
    fn lookup(&self, name: &str, is_nested: bool) -> Result<Option<Value>>;
    /// A property of an included namespace.
    fn member(&self, scope: &Rc<Scope>, name: &str) -> Result<Option<Value>>;
    fn load_yaml(&self, file: &str) -> Result<Value>;
    fn absolute(&self, file: &str) -> String;
    fn argument(&self, name: &str) -> Option<Rc<str>>;
    fn message(&self, kind: &str, text: String);
}
