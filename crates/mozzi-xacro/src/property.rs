//! `<xacro:property>`.

use crate::condition::{literal, truth};
use crate::document::Id;
use crate::expander::Expander;
use crate::expression::{KEYWORDS, Value, begins_name, continues_name, global};
use crate::fault::{Fault, Result};
use crate::scope::{Property, Scope};
use std::rc::Rc;

const ATTRIBUTES: [&str; 5] = ["value", "default", "remove", "scope", "lazy_eval"];

impl Expander<'_> {
    pub fn define_property(&self, id: Id, scope: &Rc<Scope>) -> Result<()> {
        self.remove_comments_before(id);
        let written = self.checked(id, &["name"], &ATTRIBUTES)?;
        let [value, default, remove, target, lazy] = ATTRIBUTES.map(|name| self.optional(id, name));
        let name = match self.evaluate(&written.value, scope, &written.place)? {
            Value::Str(name) => name,
            other => return Err(Fault::new(format!("the property's name is {}, expected text", other.kind()))),
        };
        if !is_name(&name) {
            return Err(Fault::new(format!("the property's name is `{name}`, expected a name as in Python")));
        }
        if name.starts_with("__") {
            return Err(Fault::new(format!(
                "the property's name is `{name}`, expected none with two underscores first"
            )));
        }
        // an empty word counts as none
        let given = remove.filter(|remove| !remove.value.is_empty());
        let removes = match &given {
            Some(remove) => truth(&self.evaluate(&remove.value, scope, &remove.place)?)?,
            None => false,
        };
        if usize::from(value.is_some()) + usize::from(default.is_some()) + usize::from(removes) > 1 {
            return Err(Fault::new(format!(
                "the property `{name}` has several of value, default, and remove, expected one"
            )));
        }
        let is_known = scope.find(&name).is_some() || is_global(&name);
        if removes && is_known {
            scope.remove(&name);
            self.document.borrow_mut().remove(id);
            return Ok(());
        }
        if default.is_some() {
            if target.is_some() {
                self.warn(format!("the default of `{name}` holds in this scope only"));
            }
            if is_known {
                self.document.borrow_mut().remove(id);
                return Ok(());
            }
        }
        let value = value.or(default);
        self.document.borrow_mut().remove(id);
        let lazy = lazy.filter(|lazy| !lazy.value.is_empty());
        let mut is_lazy = match &lazy {
            Some(lazy) => self.truth_of(&lazy.value, scope, &lazy.place)?,
            None => true,
        };
        let table = match target.as_ref().map(|target| &*target.value) {
            Some("global") => {
                is_lazy = false;
                scope.ancestors().last().unwrap_or_else(|| scope.clone())
            }
            Some("parent") => {
                is_lazy = false;
                self.parent(scope, &name)?
            }
            _ => scope.clone(),
        };
        let Some(value) = value else {
            table.set(&format!("**{name}"), Property::Block(id));
            return Ok(());
        };
        if is_global(&name) {
            self.warn(format!("the property `{name}` hides xacro's own `{name}`"));
        }
        if is_lazy {
            // a literal becomes a value at once, other text when it is used
            table.set(
                &name,
                match literal(Value::Str(value.value.clone())) {
                    Value::Str(text) => Property::Text(text, value.place),
                    other => Property::Value(other),
                },
            );
        } else {
            let found = self.evaluate(&value.value, scope, &value.place)?;
            table.set(&name, Property::Value(literal(found)));
        }
        Ok(())
    }

    /// The caller's scope: that of a macro, skipping the namespaces between.
    fn parent(&self, scope: &Rc<Scope>, name: &str) -> Result<Rc<Scope>> {
        let none = || {
            Fault::new(format!("the property `{name}` has the scope parent, expected a macro or namespace around it"))
        };
        let mut parent = scope.parent.clone().ok_or_else(none)?;
        if !scope.is_namespace {
            while parent.is_namespace {
                parent = parent.parent.clone().ok_or_else(none)?;
            }
        }
        Ok(parent)
    }
}

/// True if Python accepts it as a name, and it is not a keyword.
fn is_name(name: &str) -> bool {
    name.starts_with(begins_name) && name.chars().all(continues_name) && !KEYWORDS.contains(&name)
}

fn is_global(name: &str) -> bool {
    global(name).is_some()
}
