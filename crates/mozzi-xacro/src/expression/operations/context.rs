//! The context that operations and functions get from the evaluation that calls them.

use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::host::Host;
use crate::expression::values::value::Value;
use crate::fault::Result;
use std::rc::Rc;

/// Evaluates for a host.
#[derive(Clone, Copy)]
pub(crate) struct Evaluator<'h> {
    pub host: &'h dyn Host,
    /// Calls a function, a method or a lambda: `sorted(…, key=…)` and `map` do.
    pub calls: fn(&Evaluator, &Value, Arguments) -> Result<Value>,
    /// `value.name`: formats have attributes.
    pub attributes: fn(&Evaluator, &Value, &Rc<str>) -> Result<Value>,
}

impl Evaluator<'_> {
    pub fn spend(&self, work: u64) -> Result<()> {
        self.host.budget().spend(work)
    }

    pub fn call(&self, called: &Value, arguments: Arguments) -> Result<Value> {
        (self.calls)(self, called, arguments)
    }

    pub fn attribute(&self, of: &Value, name: &Rc<str>) -> Result<Value> {
        (self.attributes)(self, of, name)
    }
}
