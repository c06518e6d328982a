//! Comprehensions and generator expressions.

use crate::expression::operations::context::Evaluator;
use crate::expression::syntax::{Clause, Comprehension, Form, Target};
use crate::expression::values::value::Dictionary;
use crate::expression::values::value::{Bindings, Value, bind};
use crate::fault::{Fault, Result};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// The collection that receives the elements.
enum Collected {
    Items(VecDeque<Value>),
    Entries(Dictionary),
}

impl Evaluator<'_> {
    pub fn comprehension(&self, parts: &Comprehension, bindings: &Bindings) -> Result<Value> {
        let mut collected = match parts.form {
            Form::Dict => Collected::Entries(Dictionary::default()),
            _ => Collected::Items(VecDeque::new()),
        };
        // the first items are evaluated in the surrounding scope; for a generator, an error there is raised when it is
        // made
        let Some((first, rest)) = parts.clauses.split_first() else {
            return Err(Fault::new("a comprehension without `for`"));
        };
        let (items, late) = self.items_until_error(&self.value(&first.items, bindings)?)?;
        let done = self.through(parts, first, rest, items, bindings, &mut collected);
        let end = done.err().or(late);
        match (collected, parts.form) {
            (Collected::Items(items), Form::Generator) => Ok(Value::stream(items, end)),
            (collected, form) => match (end, collected) {
                (Some(fault), _) => Err(fault),
                (None, Collected::Entries(entries)) => Ok(Value::dict(entries)),
                (None, Collected::Items(items)) if form == Form::Set => {
                    Ok(Value::Set(Rc::new(RefCell::new(Dictionary::of_keys(items)?))))
                }
                (None, Collected::Items(items)) => Ok(Value::list(items.into())),
            },
        }
    }

    /// Binds each item in turn, and continues with the other clauses.
    fn through(
        &self,
        parts: &Comprehension,
        clause: &Clause,
        rest: &[Clause],
        items: Vec<Value>,
        outer: &Bindings,
        collected: &mut Collected,
    ) -> Result<()> {
        'items: for item in items {
            self.spend(1)?;
            let bindings = self.bind_target(&clause.target, item, outer)?;
            for condition in &clause.conditions {
                if !self.value(condition, &bindings)?.truth() {
                    continue 'items;
                }
            }
            match rest.split_first() {
                Some((next, rest)) => {
                    let items = self.all_items(&self.value(&next.items, &bindings)?)?;
                    self.through(parts, next, rest, items, &bindings, collected)?;
                }
                None => {
                    let element = self.value(&parts.element, &bindings)?;
                    match (&mut *collected, &parts.value) {
                        (Collected::Entries(entries), Some(value)) => {
                            entries.insert(element, self.value(value, &bindings)?)?;
                        }
                        (Collected::Items(items), _) => {
                            items.push_back(element);
                            if items.len() > crate::bounds::MOST_ITEMS {
                                self.host.budget().items(items.len())?;
                            }
                        }
                        _ => {}
                    }
                }
            }
        }
        Ok(())
    }

    fn bind_target(&self, target: &Target, value: Value, bindings: &Bindings) -> Result<Bindings> {
        match target {
            Target::Name(name) => Ok(bind(bindings, name, value)),
            Target::Several(at, targets) => {
                let items = self.all_items(&value).map_err(|fault| fault.or_at(*at))?;
                if items.len() != targets.len() {
                    let message = format!("{} values for {} names", items.len(), targets.len());
                    return Err(Fault::at(*at, message));
                }
                let mut bindings = bindings.clone();
                for (target, item) in targets.iter().zip(items) {
                    bindings = self.bind_target(target, item, &bindings)?;
                }
                Ok(bindings)
            }
        }
    }
}
