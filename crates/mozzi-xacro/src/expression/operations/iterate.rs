//! Iterates over the items of a value.

use crate::expression::operations::context::Evaluator;
use crate::expression::values::value::{Value, View};
use crate::fault::{Fault, Result};

impl Evaluator<'_> {
    /// All items, bounded in number. An iterator is consumed.
    pub fn all_items(&self, value: &Value) -> Result<Vec<Value>> {
        let (items, end) = self.items_until_error(value)?;
        end.map_or(Ok(items), Err)
    }

    /// The items before an error, and that error.
    pub fn items_until_error(&self, value: &Value) -> Result<(Vec<Value>, Option<Box<Fault>>)> {
        let budget = self.host.budget();
        let items = match value {
            Value::List(items, is_dotted) => {
                budget.items(items.borrow().len())?;
                let items = items.borrow();
                if *is_dotted { items.iter().map(Value::dotted).collect() } else { items.clone() }
            }
            Value::Tuple(items) => {
                budget.items(items.len())?;
                items.to_vec()
            }
            Value::Str(text) => {
                budget.items(text.len())?;
                text.chars().map(|c| Value::text(c.to_string())).collect()
            }
            Value::Dict(entries, _) | Value::View(View::Keys, entries) => {
                budget.items(entries.borrow().len())?;
                entries.borrow().keys().cloned().collect()
            }
            Value::Set(entries) => {
                budget.items(entries.borrow().len())?;
                let keys = entries.borrow().ordered_keys();
                keys.ok_or_else(|| Fault::new("the order of this set is not defined, expected `sorted(…)` of it"))?
            }
            Value::View(View::Values, entries) => {
                budget.items(entries.borrow().len())?;
                entries.borrow().entries().iter().map(|(_, value)| value.clone()).collect()
            }
            Value::View(View::Items, entries) => {
                budget.items(entries.borrow().len())?;
                let pair = |(key, value): &(Value, Value)| Value::Tuple([key.clone(), value.clone()].into());
                entries.borrow().entries().iter().map(pair).collect()
            }
            Value::Range(range) => {
                budget.items(range.len())?;
                (0..range.len()).map(|k| range.item(k)).collect()
            }
            Value::Iterator(stream) => {
                let stream = std::mem::take(&mut *stream.borrow_mut());
                budget.items(stream.items.len())?;
                return Ok((stream.items.into(), stream.end));
            }
            other => return Err(Fault::new(format!("a {} has no items to go through", other.kind()))),
        };
        Ok((items, None))
    }

    /// The items in any order, for results that do not depend on it.
    pub fn items_in_any_order(&self, value: &Value) -> Result<Vec<Value>> {
        match value {
            Value::Set(entries) => {
                self.host.budget().items(entries.borrow().len())?;
                Ok(entries.borrow().keys().cloned().collect())
            }
            other => self.all_items(other),
        }
    }
}
