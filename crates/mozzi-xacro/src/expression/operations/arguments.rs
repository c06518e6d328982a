//! The arguments of a call.

use crate::expression::values::value::Value;
use crate::fault::{Fault, Result};
use std::rc::Rc;

#[derive(Default)]
pub(crate) struct Arguments {
    pub positional: Vec<Value>,
    pub named: Vec<(Rc<str>, Value)>,
}

impl Arguments {
    pub fn of(positional: Vec<Value>) -> Self {
        Arguments { positional, named: Vec::new() }
    }

    /// Removes an argument by name.
    pub fn take(&mut self, name: &str) -> Option<Value> {
        let at = self.named.iter().position(|(known, _)| **known == *name)?;
        Some(self.named.remove(at).1)
    }

    /// Positional or keyword arguments, some optional; `called` names the function in errors.
    pub fn bound<const N: usize>(
        mut self,
        called: &str,
        names: [&str; N],
        required: usize,
    ) -> Result<[Option<Value>; N]> {
        let count = self.positional.len();
        if count > N {
            return Err(Fault::new(format!(
                "`{called}` is called with {count} arguments, expected {}",
                expected(required, N)
            )));
        }
        let mut values = [const { None }; N];
        for (place, value) in values.iter_mut().zip(std::mem::take(&mut self.positional)) {
            *place = Some(value);
        }
        for (i, name) in names.iter().enumerate() {
            if !name.is_empty() && values[i].is_none() {
                values[i] = self.take(name);
            }
        }
        if let Some((name, _)) = self.named.first() {
            return Err(Fault::new(format!("`{called}` has no argument `{name}` here")));
        }
        match values[..required].iter().any(Option::is_none) {
            true => Err(Fault::new(format!(
                "`{called}` is called with {count} arguments, expected {}",
                expected(required, N)
            ))),
            false => Ok(values),
        }
    }

    /// Exactly this many positional arguments.
    pub fn exactly<const N: usize>(self, called: &str) -> Result<[Value; N]> {
        let values = self.bound(called, [""; N], N)?;
        Ok(values.map(|value| value.unwrap_or(Value::None)))
    }

    /// All positional arguments; keyword arguments are refused.
    pub fn only_positional(self, called: &str) -> Result<Vec<Value>> {
        match self.named.first() {
            Some((name, _)) => Err(Fault::new(format!("`{called}` has no argument `{name}`"))),
            None => Ok(self.positional),
        }
    }
}

fn expected(least: usize, most: usize) -> String {
    if least == most { format!("{most}") } else { format!("{least} to {most}") }
}
