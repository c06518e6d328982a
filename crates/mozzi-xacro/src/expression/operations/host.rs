//! The names of the surrounding expansion.

use crate::bounds::Budget;
use crate::expression::values::value::Value;
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
